#!/usr/bin/env python3
"""Prints what is installed here, Debian and Python packages with versions and licences, as CycloneDX 1.5.

Of the Python that runs it: .venv/bin/python3 for the workspace's packages.
"""

import argparse
import json
import re
import subprocess
from importlib import metadata
from pathlib import Path
from typing import Dict, Iterator, List, NamedTuple

DOCUMENTS = Path("/usr/share/doc")


class Component(NamedTuple):
    """An installed package; ``licence`` as its makers write it."""

    kind: str
    name: str
    version: str
    licence: str

    def entry(self) -> Dict[str, object]:
        """As CycloneDX has it."""
        return {
            "type": "library",
            "name": self.name,
            "version": self.version,
            "purl": f"pkg:{self.kind}/{self.name}@{self.version}",
            "licenses": [{"license": {"name": self.licence}}],
        }


def components() -> List[Component]:
    return sorted({*_python_packages(), *_debian_packages()})


def _python_packages() -> Iterator[Component]:
    for package in metadata.distributions():
        yield Component("pypi", package.metadata["Name"], package.version, _python_licence(package.metadata))


def _python_licence(fields) -> str:
    """The expression, else the classifiers, else the first line of what may be the whole text."""
    named = fields.get("License-Expression")
    classes = [
        name.rpartition(" :: ")[2]
        for name in fields.get_all("Classifier") or ()
        if name.startswith("License ::")
    ]
    return named or ", ".join(classes) or (fields.get("License") or "unknown").strip().split("\n")[0]


def _debian_packages() -> Iterator[Component]:
    form = "${db:Status-Status} ${Package} ${Version}\n"
    listed = subprocess.run(["dpkg-query", "-W", "-f", form], stdout=subprocess.PIPE, text=True, check=True)
    for line in listed.stdout.splitlines():
        status, name, version = line.split(" ")
        if status == "installed":
            yield Component("deb", name, version, _debian_licence(name))


def _debian_licence(name: str) -> str:
    """The short names in the copyright file, where that is in Debian's machine-readable form."""
    try:
        text = (DOCUMENTS / name / "copyright").read_text(errors="replace")
    except OSError:
        return "unknown"
    names = sorted(set(re.findall(r"^License:[ \t]*(\S.*)$", text, re.MULTILINE)))
    return ", ".join(names) or f"see {DOCUMENTS / name / 'copyright'}"


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--table", action="store_true", help="for people")
    if parser.parse_args().table:
        for component in components():
            print(f"{component.name} {component.version}: {component.licence}")
    else:
        bill = {
            "bomFormat": "CycloneDX",
            "specVersion": "1.5",
            "version": 1,
            "components": [component.entry() for component in components()],
        }
        print(json.dumps(bill, indent=1))


if __name__ == "__main__":
    main()
