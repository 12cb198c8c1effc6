"""Run the cases of this folder against the official nodes too and print what both give.

    compare.py [--only TEXT]

Each module ``*_cases.py`` has a list CASES and a dictionary RIGS from the names of rigs to Rig. Cases whose
official package is not installed are counted and left out. Exit code 0 if both give what the cases state.
"""

import argparse
import sys
from importlib import import_module
from pathlib import Path
from typing import Any, Dict, List, Tuple

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from case import Case, Rig  # noqa: E402


def load() -> Tuple[List[Case], Dict[str, Rig]]:
    """Return the cases and the rigs of all modules."""
    cases: List[Case] = []
    rigs: Dict[str, Rig] = {}
    for path in sorted(HERE.glob("*_cases.py")):
        module = import_module(path.stem)
        cases.extend(module.CASES)
        rigs.update(module.RIGS)
    return cases, rigs


def is_available(rig: Rig) -> bool:
    """Whether the official packages of a rig are installed."""
    from costmap_2d_official import find_executable  # imports ROS

    return all(find_executable(*need.split("/")) is not None for need in rig.needs)


def run(call: Any, case: Case) -> Any:
    """Return the result of a run, or the error that ended it."""
    try:
        return call(case.input)
    except Exception as error:  # a case that fails must not end the table
        return f"{type(error).__name__}: {error}"


def main() -> int:
    """Print the table; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument(
        "--only", metavar="TEXT", default="", help="only cases whose name or rig contains TEXT"
    )
    options = parser.parse_args()
    cases, rigs = load()
    chosen = [case for case in cases if options.only in case.name or options.only in case.rig]
    wrong = differing = missing = 0
    print("| statement | source | official | ours | |\n| --- | --- | --- | --- | --- |")
    for case in chosen:
        rig = rigs[case.rig]
        ours, official = run(rig.ours, case), "not installed"
        is_right = ours == case.expected
        if is_available(rig):
            official = run(rig.official, case)
            is_right = is_right and official == case.expected_of_official
        else:
            missing += 1
        wrong += not is_right
        differing += bool(case.reason)
        verdict = ("as stated: " + case.reason if case.reason else "same") if is_right else "WRONG"
        print(
            f"| {case.name.replace('_', ' ')} | {case.source} | {official} | {ours} | {verdict} |", flush=True
        )
    compared = len(chosen) - missing
    print(
        f"\n{len(chosen)} statements, {compared} compared with the official nodes: "
        f"{wrong} wrong, {differing} stated differences"
    )
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
