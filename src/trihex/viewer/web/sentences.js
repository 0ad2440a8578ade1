// Sentences: what each number on the page means, for who points at it.

export const OF_PLAN = {
  "Total time": "The sum over all robots of their moves and waits, in time units: what a planner keeps small.",
  "Lower bound": "No plan for these robots takes less total time; how this is known stands in brackets.",
  "Gap to the optimum": "How far the total time lies above the least that is possible, as far as that is known.",
  "Steps": "Time steps until the last robot arrives; in each, every robot makes one move or waits.",
  "Last arrival": "Seconds until the last robot arrives, at 1 metre a second unless another speed was told.",
  "Moves d": "What all moves cost together: 10 over an edge, 14 through a corner, unless the rules say otherwise.",
  "Waiting w": "What all waits cost together: each robot that stands still in a step adds the waiting cost.",
  "Longest t": "The time of the robot that takes longest: its moves and its waits, in time units.",
  "Arrived": "Robots that reach a destination.",
  "With full knowledge, no events": "Total time of a plan for robots that know everything, where nothing changes.",
  "Price": "How much more time this run took than that plan: what not knowing and the changes cost.",
  "Events": "How often a wall, a destination or a robot came, went or failed during the run.",
  "Conflicts": "Places where two robots would meet, found by a judge who knows no planner.",
  "Moves past corners": "Moves through a corner at which a wall or the border stands; Rules can forbid them.",
  "Planned in": "Seconds that the planner took on this computer.",
};

export const OF_SETS = "How many robots move and wait in the step that begins now, and how many have arrived.";

// How a lower bound is known, by its name.
export const OF_BOUNDS = {
  distance: "distance: as if nobody were in the way of anybody",
  slot: "slot: so many robots at most enter the destinations in a step",
  cut: "cut: so many robots at most pass the narrow places in a step",
  optimum: "optimum: a plan that takes no more has been found",
};

export const OF_LIVE = {
  "Step": "Time steps since the run began. In each step every robot makes one move or waits.",
  "Arrived": "Robots that have reached a destination, of all that are or were here.",
  "On the way": "Robots that still go; those that are cut off have no way to a destination.",
  "Total time so far": "The sum over all robots of their moves and waits so far, in time units.",
  "Milliseconds a step": "How long this computer thinks about a step: the middle of all, the last, the worst.",
  "Repairs of the field": "How often the distances were mended because a wall or a destination came or went.",
  "Cells they touched": "Cells whose distance was looked at again in all repairs together.",
  "Known": "Share of the cells that some robot has seen.",
  "With full knowledge, no events": "Total time of a plan for robots that know everything, where nothing changes.",
  "Price": "How much more time this run took than that plan: what not knowing and the changes cost.",
  "Conflicts": "Places where two robots met, found by a judge who knows no planner.",
};

export const OF_ROBOT = {
  "moves d": "What the moves of this robot cost.",
  "waits w": "What its waits cost: the waiting cost for each step in which it stands still.",
  "time t = d + w": "Its time: moves and waits together, in time units.",
};

export const OF_RULES = {
  neighbourhood: "Full: robots also move to cells that share only a corner. Edge: only to cells that share an edge.",
  costs: "Paper: 10 over an edge, 14 through a corner. Euclidean: true distances, 1000 for an edge.",
  corners: "Allow: robots pass any corner. No-squeeze: not between two walls. No-cut: past no corner of a wall.",
  crossing: "Forbid: no two robots pass the same corner in one step. Allow: they may.",
  clock: "Steps: every move lasts one step. Costs: a move lasts as long as it costs, in ticks; a wait lasts a tick.",
  following: "Allow: a robot may move up into a cell that is being left. Forbid: nobody enters it until it is empty.",
  waiting_cost: "What a robot pays for each step in which it stands still; by default as much as a move over an edge.",
  destination_capacity: "How many robots may enter a destination in one step, 1/2: one in two; by default any number.",
};

export const UNITS = "Times are in time units: a move over an edge takes";
