// Names: what robots and cells are called: robots by letters where they are few, as in pictures, and by numbers.

const LETTERS = "abcdefghijklmnopqrstuvwxyz"; // as many robots as have one

// What stands on the disc of a robot, one of so many.
export const signOf = (robot, count) => (count <= LETTERS.length ? LETTERS[robot] : String(robot));

// The number that files know it by stands beside its letter.
export const nameOfRobot = (robot, count) =>
  (count <= LETTERS.length ? `robot ${LETTERS[robot]} (number ${robot})` : `robot ${robot}`);

export const nameOfCell = ({ width }, cell) => `(${cell % width}, ${Math.floor(cell / width)})`;
