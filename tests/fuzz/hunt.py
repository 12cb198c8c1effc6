#!/usr/bin/env python3
"""Feeds thousands of broken files to each file reader and stores those not rejected with a PlanarError."""

import hashlib
import json
import os
import select
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Dict, List, Optional, Tuple

ROOT = Path(__file__).resolve().parents[2]
FOLDER = Path(__file__).resolve().parent
sys.path[:0] = [str(FOLDER), *(str(path) for path in sorted(ROOT.glob("src/**/src")))]

from readers import READERS, Reader, prepare  # noqa: E402
from trial import SECONDS  # noqa: E402

from supervision.command_line import count, option, parse, seconds  # noqa: E402  # noqa: E402
from supervision.display import print_error  # noqa: E402

# A reader that does not react to its time limit is killed after this time [s].
UNRESPONSIVE_SECONDS = 12.0 * SECONDS
# Time limit for imports and for reading the corpus [s].
START_SECONDS = 300.0
# Period of progress output [s].
LOG_SECONDS = 15.0
MANY = 1_000_000_000


@dataclass(frozen=True)
class Fuzz:
    """Give every reader of files thousands of malformed ones.

    Stores those that it does not refuse with an error message within 5 s and 1 GB (docs/how_to/fuzz.md).

    Exit code: 0 nothing found, 1 failures found, 2 invalid input, 130 interrupted.
    """

    minutes: float = option(5.0, "for all readers together", type=seconds)
    cases: Optional[int] = option(
        None, "maximum number of files for each reader (default: unlimited)", type=count
    )
    reader: Optional[Tuple[str, ...]] = option(
        None,
        "only these, such as world or map_image (default: all)",
        nargs="+",
        choices=tuple(READERS),
        metavar="NAME",
    )
    seed: int = option(0, "seed", type=int)
    output: Path = option(ROOT / "build/fuzz", "folder of results", type=Path, metavar="FOLDER")


@dataclass
class Hunt:
    """Number of files read, and for each fault a file that causes it."""

    cases: int = 0
    faults: Dict[str, Path] = field(default_factory=dict)


class Hunter:
    """Runs a process that reads broken files, and restarts it after a crash."""

    def __init__(self, reader: Reader, folder: Path, output: Path, options: Fuzz):
        self._reader, self._case = reader, folder / reader.file_name
        self._findings, self._corpus = output / reader.name, output / "corpus" / reader.name
        self._seed, self._cases = options.seed, options.cases or MANY
        self._ending = time.monotonic() + 60.0 * options.minutes / len(options.reader or READERS)
        self._found = Hunt()
        self._news = b""

    def hunt(self) -> Hunt:
        """Run until the time is over or all cases are read."""
        self._corpus.mkdir(parents=True, exist_ok=True)
        for data in self._reader.seeds:
            (self._corpus / hashlib.sha256(data).hexdigest()[:12]).write_bytes(data)
        attempt = 0
        while time.monotonic() < self._ending and self._found.cases < self._cases:
            before = self._found.cases
            fault = self._run_process(self._seed + attempt)
            attempt += 1
            if fault:
                self._keep(fault, self._case.read_bytes())
            elif self._found.cases == before:
                raise RuntimeError(f"no file was read: {FOLDER / 'reading.py'} {self._reader.name}")
        return self._found

    def _run_process(self, seed: int) -> str:
        """Run one process to its end; return how it failed, or an empty text."""
        news, news_writer = os.pipe()
        arguments: Dict[str, object] = {
            "case": self._case,
            "corpus": self._corpus,
            "seconds": max(1, round(self._ending - time.monotonic())),
            "cases": self._cases - self._found.cases,
            "seed": seed,
            "news": news_writer,
        }
        flags = [f"--{name}={value}" for name, value in arguments.items()]
        process = subprocess.Popen(
            [sys.executable, str(FOLDER / "reading.py"), self._reader.name, *flags],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            pass_fds=[news_writer],
            cwd=self._case.parent,  # Atheris writes files to its working directory
        )
        os.close(news_writer)
        try:
            return self._watch(process, news)
        finally:
            process.kill()
            process.wait()
            os.close(news)

    def _watch(self, process: "subprocess.Popen[bytes]", news: int) -> str:
        before, patience = self._found.cases, START_SECONDS
        last_event = last_log = time.monotonic()
        while True:
            if select.select([news], [], [], 0.5)[0]:
                events = self._events(news)
                if not events:
                    break
                last_event, patience = time.monotonic(), UNRESPONSIVE_SECONDS
                for event in events:
                    self._found.cases = before + event["cases"]
                    if "fault" in event:
                        self._keep(event["fault"], bytes.fromhex(event["data"]))
            now = time.monotonic()
            if now - last_log > LOG_SECONDS:
                last_log = now
                self._print(f"{self._found.cases} files, {len(self._found.faults)} faults")
            if now - last_event > patience:
                return f"unresponsive for {patience:g} s"
        code = process.wait()
        if code < 0:
            return f"ended by {signal.Signals(-code).name}"
        return f"ended with exit code {code}" if code else ""

    def _events(self, news: int) -> List[Dict[str, object]]:
        """Read the events since the last call; empty if the process has ended."""
        while True:
            data = os.read(news, 1 << 20)
            self._news += data
            *lines, self._news = self._news.split(b"\n")
            if lines or not data:
                return [json.loads(line) for line in lines]

    def _keep(self, fault: str, data: bytes) -> None:
        if fault in self._found.faults:
            return
        path = self._findings / hashlib.sha256(data).hexdigest()[:12]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
        self._found.faults[fault] = path
        self._print(f"{fault}\n    {path}")

    def _print(self, text: str) -> None:
        print(f"  {self._reader.name}: {text}", flush=True)


def _memory_folder() -> Optional[str]:
    """Return a folder in memory, if there is one; each file is written and read once."""
    return "/dev/shm" if os.access("/dev/shm", os.W_OK) else None


def main() -> int:
    options = parse(Fuzz, sys.argv[1:], "fuzz.sh")
    if not find_spec("atheris"):
        print_error("Atheris is not installed; run ./scripts/setup.sh --dev (x86_64 only)")
        return 2
    faults = cases = 0
    for name in options.reader or READERS:
        with tempfile.TemporaryDirectory(dir=_memory_folder()) as folder:
            prepare(Path(folder))
            found = Hunter(READERS[name], Path(folder), options.output, options).hunt()
        print(f"{name}: {found.cases} files, {len(found.faults)} faults", flush=True)
        faults, cases = faults + len(found.faults), cases + found.cases
    print(f"{cases} files, {faults} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
