"""Rules by which simulated time passes beside nodes that do not take part in lock-step."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Dict, FrozenSet, Mapping, Optional

from planar.config.hints import hint
from planar.config.yaml_table import read_table
from planar.errors import SettingsError

# Kinds of rules, and what the simulation does beside a node with such a rule.
MEANINGS = {
    "rest": "time waits until all its threads rest",
    "stamps": "time waits for its messages on {topic}",
    "observe": "time does not wait for it",
    "real_time": "time passes in real time at most",
}
# How far runs repeat beside a node of which nothing else is known.
REPEATS = {
    "rest": "repeats to the bit unless two of its threads race",
    "stamps": "does not repeat to the bit: its messages arrive within a period of time",
    "observe": "repeats if nothing depends on what it sends",
    "real_time": "does not repeat: its work depends on wall time",
}
FORMS = "rest, stamps=TOPIC, observe or real_time"


@dataclass(frozen=True)
class PaceRule:
    """How simulated time passes beside a node.

    Attributes:
        kind: A key of ``MEANINGS``.
        topic: Topic of the node's stamped messages, for ``stamps``.
        reason: Why the node has this rule.
        repeats: How far runs repeat beside this node; empty: as usual for the kind.
        keeps: Topics whose messages the node keeps until the clock, or another topic, has it use them.
        timers: Whether something depends on when in an instant its timers run.
    """

    kind: str
    topic: str = ""
    reason: str = ""
    repeats: str = ""
    keeps: FrozenSet[str] = frozenset()
    timers: bool = True

    def sentence(self, name: str) -> str:
        """Return the rule of a node in words: rule, reason, and how far runs repeat."""
        meaning = MEANINGS[self.kind].format(topic=self.topic)
        return f"{name}: {meaning} ({self.kind}: {self.reason}); {self.repeats or REPEATS[self.kind]}"


@dataclass(frozen=True)
class NodeFacts:
    """What is known of a node from the graph and from this machine.

    Attributes:
        name: Name with slash.
        program: File name of its program or script, without ``.py``; empty: it runs on another machine.
        follows_clock: Whether it subscribes to ``/clock``.
    """

    name: str
    program: str
    follows_clock: bool


def parse_rule(text: str, reason: str = "") -> PaceRule:
    """Parse a rule.

    Args:
        text: ``rest``, ``stamps=TOPIC``, ``observe`` or ``real_time``.
        reason: Where the rule comes from.

    Raises:
        SettingsError: There is no such rule.
    """
    kind, _, topic = text.partition("=")
    if kind not in MEANINGS:
        raise SettingsError(f'unknown rule "{text}"{hint(kind, MEANINGS)}; expected {FORMS}')
    if (kind == "stamps") != bool(topic):
        raise SettingsError(f'rule "{text}": expected {FORMS}')
    return PaceRule(kind, f"/{topic.lstrip('/')}" if topic else "", reason)


def parse_rules(text: str) -> Dict[str, PaceRule]:
    """Parse ``NODE:RULE`` entries that are separated by spaces.

    Returns:
        The rules by the name of the node, with slash.

    Raises:
        SettingsError: An entry is not valid, or a node has two rules.
    """
    rules: Dict[str, PaceRule] = {}
    for entry in text.split():
        node, colon, rule = entry.partition(":")
        if not colon or not node.strip("/"):
            raise SettingsError(f'pace: "{entry}" must be NODE:RULE, such as planner:rest')
        name = f"/{node.lstrip('/')}"
        if name in rules:
            raise SettingsError(f"pace: {name} has two rules")
        try:
            rules[name] = parse_rule(rule, "set by pace")
        except SettingsError as error:
            raise SettingsError(f'pace: "{entry}": {error}') from None
    return rules


def read_known_nodes(path: Path) -> Dict[str, PaceRule]:
    """Read the rules of known programs.

    Args:
        path: YAML file: program -> ``rule`` and, optionally, ``repeats``, ``keeps`` and ``timers``.

    Raises:
        SettingsError: The file is not valid.
    """
    table = read_table(path)
    rules: Dict[str, PaceRule] = {}
    for program in table:
        entry = table.table(program)
        entry.allow_only("rule", "repeats", "keeps", "timers")
        try:
            rule = parse_rule(entry.text("rule"))
        except SettingsError as error:
            raise entry.error_at("rule", f"is invalid: {error}") from None
        repeats = entry.text("repeats", REPEATS[rule.kind])
        keeps = frozenset(entry.text("keeps").split()) if "keeps" in entry else frozenset()
        timers = entry.flag("timers", True)
        rules[program] = PaceRule(rule.kind, rule.topic, f"known program {program}", repeats, keeps, timers)
    return rules


def choose_rule(node: NodeFacts, named: Mapping[str, PaceRule], known: Mapping[str, PaceRule]) -> PaceRule:
    """Choose the rule of a node: the one set for its name, that of its program, or one learned.

    Args:
        node: What is known of it.
        named: Rules by name.
        known: Rules by program.
    """
    rule: Optional[PaceRule] = named.get(node.name)
    if rule is not None and (rule.kind != "rest" or node.program):
        return rule
    if not node.program:
        return PaceRule("real_time", reason="it runs on another machine")
    if node.program in known:
        return known[node.program]
    if not node.follows_clock:
        return PaceRule("real_time", reason="it does not subscribe to /clock")
    return PaceRule("rest", reason="learned: it subscribes to /clock")


def program_of(command_line: Any) -> str:
    """Return the file name of a program, or of the script that Python runs, without ``.py``.

    Args:
        command_line: Words of the command line.
    """
    words = list(command_line)
    if words and Path(words[0]).name.startswith("python"):
        words = [word for word in words[1:] if not word.startswith("-")] or words
    name = Path(words[0]).name if words else ""
    return name[:-3] if name.endswith(".py") else name
