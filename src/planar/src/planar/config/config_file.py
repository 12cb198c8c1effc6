"""YAML files that document every parameter of a package, generated from its settings dataclasses.

A package declares its files in its ``config`` module; ``docs/generate.py`` writes them::

    CONFIG_FILES = {
        "tea.yaml": Section(
            "",
            TeaSettings,                               # its parameters, in the order of the fields
            Parameter("cups", 2, "number of cups"),    # a parameter outside any settings class
            Section("sugar", SugarSettings),           # a nested table
            Section("honey", SugarSettings(lumps=0)),  # values of an instance instead of the defaults
            Section("syrup", same_as="honey"),         # a YAML alias of another section
            about="Every parameter of tea with its default.",
        ),
    }
"""

from typing import Any, Dict, List, Union

import yaml

from planar.config.parameters import Parameter, parameters_of, with_unit

LINE_LENGTH = 110
# Longer entries do not shift the column of comments of the other entries.
LONGEST_ALIGNED = 44


class Section:
    """A table of a YAML file with its parameters and nested tables.

    Attributes:
        name: Key of the table; empty for the whole file.
        parts: Parameters and nested sections in the order of the file.
        about: Comment of the section.
        same_as: Name of the section whose values this one repeats, if any.
    """

    def __init__(self, name: str, *parts: Any, about: str = "", same_as: str = ""):
        """Collect the parts of a section.

        Args:
            name: Key of the table; empty for the whole file.
            parts: Parameters, sections, settings classes or instances of settings classes.
            about: Comment of the section.
            same_as: Name of another section to be repeated.
        """
        self.name, self.about, self.same_as = name, about, same_as
        self.parts = tuple(part for given in parts for part in _parts(given))


def render_yaml(section: Section) -> str:
    """Return the text of a configuration file with the unit, meaning and choices of parameters."""
    anchors = {part.same_as for part in section.parts if isinstance(part, Section)}
    lines = [f"# {line}" for line in section.about.splitlines()]
    return "\n".join([*lines, *_lines(section, "", anchors)]) + "\n"


def _lines(section: Section, indent: str, anchors) -> List[str]:
    lines: List[str] = []
    group: List[Parameter] = []
    for part in section.parts:
        if isinstance(part, Section) or part.heading:
            lines += _aligned(group, indent)
            group = []
        if isinstance(part, Parameter):
            lines += ["", f"{indent}# {part.heading}"] if part.heading else []
            group.append(part)
        else:
            lines += [*([] if indent else [""]), _head(part, indent, anchors)]
            lines += _lines(part, indent + "  ", anchors)
    return lines + _aligned(group, indent)


def _head(section: Section, indent: str, anchors) -> str:
    mark = f" &{section.name}" if section.name in anchors else ""
    mark = f" *{section.same_as}" if section.same_as else mark
    about = f"  # {section.about}" if section.about else ""
    return f"{indent}{section.name}:{mark}{about}"


def _aligned(group: List[Parameter], indent: str) -> List[str]:
    """Return the lines of parameters with their comments aligned in one column."""
    entries = [_entry(part, indent) for part in group]
    lengths = [len(entry[0]) for entry in entries if len(entry[0]) <= LONGEST_ALIGNED]
    column = max(lengths, default=0) + 2
    lines = []
    for part, entry in zip(group, entries):
        comment = with_unit(part.unit, _meaning(part))
        lines += [*_commented(entry[0], comment, column), *entry[1:]]
    return lines


def _entry(part: Parameter, indent: str) -> List[str]:
    """Return the lines of a key and its value; a list of tables takes one line for each table."""
    if part.required:
        return [f"{indent}# {part.name}"]
    if isinstance(part.default, (list, tuple)) and any(isinstance(item, dict) for item in part.default):
        return [f"{indent}{part.name}:", *(f"{indent}  - {_in_line(item)}" for item in part.default)]
    return [f"{indent}{part.name}: {_in_line(part.default)}"]


def _commented(entry: str, comment: str, column: int) -> List[str]:
    """Return an entry with its comment beside it, continued on lines below where it is too long."""
    start = max(column, len(entry) + 2)
    lines, words = [""], comment.split()
    for word in words:
        if lines[-1] and start + 3 + len(lines[-1]) + len(word) > LINE_LENGTH:
            lines.append("")
        lines[-1] += f" {word}"
    beside = [f"{text:<{start}}#{line}" for text, line in zip([entry, *[""] * len(lines)], lines)]
    return beside if comment else [entry]


def _meaning(part: Parameter) -> str:
    return ("required: " if part.required else "") + part.meaning_and_choices


def _in_line(value: Any) -> str:
    plain = list(value) if isinstance(value, tuple) else value
    return yaml.safe_dump([plain], default_flow_style=True, width=10**6, sort_keys=False).strip()[1:-1]


def _parts(given: Any) -> List[Union[Parameter, Section]]:
    if isinstance(given, (Parameter, Section)):
        return [given]
    if isinstance(given, type):
        return list(parameters_of(given))
    return [each.with_default(getattr(given, each.field)) for each in parameters_of(type(given))]


ConfigFiles = Dict[str, Section]
