"""Broken files, earlier findings and a few hundred new ones, are read or rejected with a PlanarError."""

import random
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from mutation import mutated
from readers import READERS, prepare
from trial import tried

FOUND = [(reader.name, path) for reader in READERS.values() for path in reader.findings]
EXAMPLES = 30


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    made = tmp_path_factory.mktemp("files")
    prepare(made)
    return made


def fault_of(name, data, folder):
    path = folder / READERS[name].file_name
    path.write_bytes(data)
    return tried(READERS[name], path).fault


@pytest.mark.parametrize("name", READERS)
def test_valid_files_are_read(name, folder):
    for data in READERS[name].examples():
        assert fault_of(name, data, folder) is None


@pytest.mark.parametrize(("name", "path"), FOUND, ids=[f"{name}-{path.name}" for name, path in FOUND])
def test_earlier_findings_cause_no_fault(name, path, folder):
    assert fault_of(name, path.read_bytes(), folder) is None


@pytest.mark.parametrize("name", READERS)
def test_a_broken_file_is_rejected_with_a_planar_error(name, folder):
    hypothesis = pytest.importorskip("hypothesis")
    seeds = READERS[name].seeds

    @hypothesis.settings(max_examples=EXAMPLES, deadline=None, derandomize=True, database=None)
    @hypothesis.given(hypothesis.strategies.integers(0, 2**64 - 1))
    def holds(number):
        rng = random.Random(number)
        assert fault_of(name, mutated(rng.choice(seeds), seeds, rng), folder) is None

    holds()
