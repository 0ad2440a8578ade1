"""All pictures of the documentation: `python -m examples [FOLDER]`, by default into docs/figures."""

import runpy
import sys
from pathlib import Path

from examples.drawing import folder_from_arguments

folder = folder_from_arguments()
folder.mkdir(parents=True, exist_ok=True)
sys.argv = [sys.argv[0], str(folder)]
for module in ("examples.paper", "examples.concepts"):
    runpy.run_module(module, run_name="__main__")
for script in sorted(Path(__file__).parent.glob("*.py")):
    if script.stem not in ("__main__", "drawing", "concepts", "check_certificate", "executor"):
        print(f"-- {script.name}")
        runpy.run_path(str(script), run_name="__main__")
(folder / "waypoints.csv").unlink()
