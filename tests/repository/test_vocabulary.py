"""One term for one concept: no retired words, no class name twice, few very short modules."""

from pathlib import Path

import pytest
import vocabulary

ROOT = vocabulary.ROOT
RULES = vocabulary.load_rules()
MOST_DUPLICATES, MOST_SHORT_MODULES = 15, 50
README_LINES, CHANGELOG_LINES = 120, 150


@pytest.fixture(scope="module")
def hits():
    return list(vocabulary.find_hits(ROOT, vocabulary.text_files(ROOT), RULES))


def test_no_text_or_identifier_uses_a_retired_word(hits):
    assert [str(hit) for hit in hits] == []


def test_no_class_or_function_has_a_retired_name():
    assert vocabulary.retired_definitions(ROOT, RULES) == []


def test_a_class_name_is_used_once_or_listed_with_its_reason():
    duplicates = vocabulary.duplicate_classes(ROOT)
    unlisted = {name: places for name, places in duplicates.items() if name not in RULES["duplicates"]}
    assert unlisted == {}, "rename one of them, or list the name in retired_words.yaml with the reason"
    assert len(duplicates) <= MOST_DUPLICATES
    assert all(name in duplicates for name in RULES["duplicates"]), "a listed name occurs only once"


def test_few_modules_are_very_short():
    short = vocabulary.short_modules(ROOT)
    assert len(short) < MOST_SHORT_MODULES, "merge what belongs to one subject:\n" + "\n".join(short)


def test_readme_and_changelog_stay_short():
    assert vocabulary.line_count(ROOT / "README.md") <= README_LINES
    assert vocabulary.line_count(ROOT / "CHANGELOG.md") <= CHANGELOG_LINES


@pytest.mark.parametrize(
    "line", ["def told(self):", "class KeyScan:", "It hears nothing.", "a_key_scan = None", "the crew's plan"]
)
def test_a_retired_word_is_found_in_text_and_in_identifiers(line):
    (hit,) = vocabulary.hits_of("module.py", 1, line, vocabulary.retired_words(RULES))
    assert hit.use in str(hit)


@pytest.mark.parametrize("line", ["pure pursuit", "class PurePursuit:", "make sure that it is set", "stella"])
def test_the_fields_own_words_are_allowed(line):
    assert list(vocabulary.hits_of("module.py", 1, line, vocabulary.retired_words(RULES))) == []


def test_a_second_class_of_one_name_is_found(tmp_path):
    for package in ("one", "two"):
        folder = tmp_path / "src" / package
        folder.mkdir(parents=True)
        (folder / "module.py").write_text("class Scan:\n    pass\n")
    assert list(vocabulary.duplicate_classes(Path(tmp_path))) == ["Scan"]
