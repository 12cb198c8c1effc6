#!/usr/bin/env python3
"""Gives every reader of files thousands of broken ones, and keeps those that it does not refuse in words."""

import argparse
import hashlib
import multiprocessing
import os
import random
import signal
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(Path(__file__).parent), *(str(path) for path in sorted(ROOT.glob("src/**/src")))]

from mutation import mutated  # noqa: E402
from readers import READERS, Reader, prepare  # noqa: E402
from trial import SECONDS, limit_memory, tried  # noqa: E402

# A reader that does not even hear the alarm is ended.
DEAF_SECONDS = 12.0 * SECONDS
# Files that went a way of their own, to be changed further.
MOST_IN_POOL = 400
TELL_SECONDS = 15.0


@dataclass
class Hunt:
    """How many files a reader was given, and by each fault a file that it was found with."""

    cases: int = 0
    faults: Dict[str, Path] = field(default_factory=dict)


class Hunter:
    """Watches over a process that reads one broken file after the other; if it dies, another follows."""

    def __init__(self, reader: Reader, folder: Path, findings: Path, seed: int, ending: float):
        self._reader, self._case = reader, folder / reader.file_name
        self._findings = findings / reader.name
        self._seed, self._ending = seed, ending
        self._cases = multiprocessing.Value("q", 0)
        self._news, self._tell = multiprocessing.Pipe(duplex=False)
        self._found = Hunt()

    def hunt(self) -> Hunt:
        """Until the time is over."""
        attempt = 0
        while time.monotonic() < self._ending:
            attempt += 1
            process = multiprocessing.Process(target=self._read_on, args=(attempt,), daemon=True)
            process.start()
            fault = self._watch(process)
            if fault:
                self._keep(fault, self._case.read_bytes())
        self._found.cases = self._cases.value
        return self._found

    def _watch(self, process: multiprocessing.Process) -> str:
        """Until it ends; says of what, if it should not have."""
        cases, since, told = -1, time.monotonic(), time.monotonic()
        while process.is_alive():
            process.join(0.1)
            self._hear()
            now = time.monotonic()
            if self._cases.value != cases:
                cases, since = self._cases.value, now
            if now - told > TELL_SECONDS:
                told = now
                print(f"  {self._reader.name}: {cases} files, {len(self._found.faults)} faults", flush=True)
            if now - since > DEAF_SECONDS:
                process.kill()
                process.join()
                return f"deaf for {DEAF_SECONDS:g} s"
        self._hear()
        code = process.exitcode or 0
        return f"ended by {signal.Signals(-code).name}" if code < 0 else ""

    def _hear(self) -> None:
        while self._news.poll():
            self._keep(*self._news.recv())

    def _keep(self, fault: str, data: bytes) -> None:
        if fault in self._found.faults:
            return
        path = self._findings / hashlib.sha256(data).hexdigest()[:12]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        self._found.faults[fault] = path
        print(f"  {self._reader.name}: {fault}\n    {path}", flush=True)

    def _read_on(self, attempt: int) -> None:
        """Of the other process: the work."""
        _be_silent()
        limit_memory()
        rng = random.Random(f"{self._reader.name} {self._seed} {attempt}")
        seeds = self._reader.seeds
        pool, ways = list(seeds), set()
        while time.monotonic() < self._ending:
            data = mutated(rng.choice(pool), seeds, rng)
            self._case.write_bytes(data)
            outcome = tried(self._reader, self._case)
            self._cases.value += 1
            if outcome.way in ways:
                continue
            ways.add(outcome.way)
            if outcome.fault:
                self._tell.send((outcome.fault, data))
            elif len(pool) < MOST_IN_POOL:
                pool.append(data)


def _be_silent() -> None:
    """What libraries say of broken files is of no interest."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)


def main() -> int:
    parser = argparse.ArgumentParser(prog="fuzz.sh", description=__doc__)
    parser.add_argument("--minutes", type=float, default=5.0, help="for all readers together (default: 5)")
    parser.add_argument("--reader", nargs="+", choices=READERS, default=list(READERS), metavar="NAME")
    parser.add_argument("--seed", type=int, default=0, help="of all chance (default: 0)")
    parser.add_argument("--output", type=Path, default=ROOT / "build/fuzz", help="findings are kept here")
    options = parser.parse_args()
    if not options.minutes > 0.0:
        parser.error("--minutes must be positive")
    faults = cases = 0
    for name in options.reader:
        ending = time.monotonic() + 60.0 * options.minutes / len(options.reader)
        with tempfile.TemporaryDirectory() as folder:
            prepare(Path(folder))
            found = Hunter(READERS[name], Path(folder), options.output, options.seed, ending).hunt()
        print(f"{name}: {found.cases} files, {len(found.faults)} faults", flush=True)
        faults, cases = faults + len(found.faults), cases + found.cases
    print(f"{cases} files, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
