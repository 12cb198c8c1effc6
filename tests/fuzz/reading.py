#!/usr/bin/env python3
"""Runs one reader under Atheris until time or cases are over, and reports its faults.

Atheris measures code coverage and mutates files that reach new code further.
"""

import argparse
import json
import os
import random
import re
import sys
import time
from pathlib import Path
from typing import List

ROOT = Path(__file__).resolve().parents[2]
SOURCES = sorted(ROOT.glob("src/**/src"))
sys.path[:0] = [str(Path(__file__).parent), *map(str, SOURCES)]

import atheris  # noqa: E402
from mutation import mutated  # noqa: E402
from readers import READERS, Reader  # noqa: E402
from trial import limit_memory, tried  # noqa: E402

# Python libraries that are instrumented besides our packages.
LIBRARIES = ["yaml", "PIL", "trimesh", "collada", "rosbag", "genpy"]
# Files grow to this size [bytes], or to twice the longest example.
MIN_SIZE_LIMIT = 4096
# Share of mutations from mutation.py; the rest are Atheris' own, which do not parse numbers and words.
CUSTOM_SHARE = 0.7
# Period of progress events [s].
EVENT_SECONDS = 1.0


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("reader", choices=READERS)
    parser.add_argument("--case", type=Path, required=True, help="the file to write and to read")
    parser.add_argument(
        "--corpus", type=Path, required=True, help="folder of files to begin with and to add to"
    )
    parser.add_argument("--seconds", type=int, required=True)
    parser.add_argument("--cases", type=int, required=True)
    parser.add_argument("--seed", type=int, required=True)
    parser.add_argument(
        "--news", type=int, required=True, help="descriptor for a line of JSON for each event"
    )
    options = parser.parse_args()
    reader = READERS[options.reader]
    with atheris.instrument_imports(include=[*_packages(), *LIBRARIES], exclude=_compiled()):
        for example in reader.examples():
            options.case.write_bytes(example)
            tried(reader, options.case)
    limit_memory()
    _fuzz(reader, options)


def _fuzz(reader: Reader, options: argparse.Namespace) -> None:
    seeds, faults, count, last_event = reader.seeds, set(), 0, 0.0
    longest = max(MIN_SIZE_LIMIT, 2 * max(map(len, seeds)))

    def read(data: bytes) -> None:
        nonlocal count, last_event
        options.case.write_bytes(data)
        outcome = tried(reader, options.case)
        count += 1
        if time.monotonic() - last_event > EVENT_SECONDS or count == options.cases:
            last_event = time.monotonic()
            _report(options.news, cases=count)
        if outcome.fault and outcome.path not in faults:
            faults.add(outcome.path)
            _report(options.news, cases=count, fault=outcome.fault, data=data.hex())

    def change(data: bytes, _longest: int, seed: int) -> bytes:
        rng = random.Random(seed)
        if rng.random() < CUSTOM_SHARE:
            return mutated(data, seeds, rng)[:longest]
        return atheris.Mutate(data, len(data))

    flags = {
        "seed": options.seed + 1,  # 0 means a seed from the clock
        "runs": options.cases,
        "max_total_time": options.seconds,
        "max_len": longest,
        "len_control": 0,
        "timeout": 0,  # time and memory are limited by the trial
        "rss_limit_mb": 0,
        "verbosity": 0,
        **{f"handle_{name}": 0 for name in ("abrt", "bus", "fpe", "ill", "segv")},  # hunt.py reports crashes
    }
    words = [sys.argv[0], *(f"-{name}={value}" for name, value in flags.items()), str(options.corpus)]
    atheris.Setup(words, read, custom_mutator=change)
    atheris.Fuzz()


def _report(descriptor: int, **event: object) -> None:
    os.write(descriptor, json.dumps(event).encode() + b"\n")


def _packages() -> List[str]:
    return sorted({path.parent.name for source in SOURCES for path in source.glob("*/__init__.py")})


def _compiled() -> List[str]:
    """Modules compiled by numba, which cannot compile instrumented code."""
    found = []
    for source in SOURCES:
        for path in source.rglob("*.py"):
            if re.search(r"\bnjit\b|\bnumba\b", path.read_text(encoding="utf-8")):
                found.append(".".join(path.relative_to(source).with_suffix("").parts))
    return sorted(found)


if __name__ == "__main__":
    main()
