"""All figures of the paper and of its errata: `python -m examples.paper [FOLDER]`."""

from examples.drawing import folder_from_arguments, save
from examples.paper import automaton, configurations, directions, fcost_by_hand, flow_chart, misprints, neighbourhoods

MODULES = (neighbourhoods, configurations, flow_chart, automaton, directions, misprints, fcost_by_hand)

if __name__ == "__main__":
    for module in MODULES:
        print(*save(folder_from_arguments(), module.figures()), sep="\n")
