"""Mutations of files: numbers, words, bits, lines and blocks."""

import random
import re
from typing import Callable, Sequence, Tuple

NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
WORD = re.compile(rb"[A-Za-z_]\w*")
# Replacements of numbers, and of words.
NUMBERS: Tuple[bytes, ...] = (
    b"nan", b".nan", b"NaN", b"inf", b"-.inf", b"Infinity", b"1e308", b"-1e308", b"1e400", b"1e-320",
    b"0", b"-0.0", b"-1", b"1.5", b"4294967296", b"18446744073709551616", b"9" * 400, b"true", b"null",
    b"~", b"", b"''", b"[]", b"{}", b"[1, 2, 3]", b"0x", b"1_000", b"01", b"1:30", b"2020-01-01", b"\xc2\xb2",
)  # fmt: skip
WORDS: Tuple[bytes, ...] = (
    b"", b"name", b"model://..", b"package://", b"file:///dev/zero", b"/dev/stdin", b"../..", b".",
    b"a" * 300, b"&a", b"*a", b"<<", b"!!python/name:os.system", b"\x00", b"\xff", b"\xef\xbb\xbf",
    b"\xe2\x80\xae", b"{", b"[", b"- ", b": ", b"\n", b"\t", b"<", b"&amp;", b"]]>", b"%s", b"$(arg a)",
)  # fmt: skip


def mutated(data: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    """Return ``data`` after a few random changes, some with parts of ``others``, files of the same kind."""
    for _ in range(rng.choice((1, 1, 1, 2, 3, 6))):
        data = rng.choice(_CHANGES)(data, others, rng)
    return data


def _span(data: bytes, rng: random.Random) -> Tuple[int, int]:
    start = rng.randrange(len(data) + 1)
    return start, min(len(data), start + rng.choice((1, 2, 4, 8, 32, 200)))


def _flip(data: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    if not data:
        return data
    at = rng.randrange(len(data))
    return data[:at] + bytes((data[at] ^ (1 << rng.randrange(8)),)) + data[at + 1 :]


def _cut_out(data: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    start, end = _span(data, rng)
    return data[:start] + data[end:]


def _cut_off(data: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    return data[: rng.randrange(len(data) + 1)]


def _double(data: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    start, end = _span(data, rng)
    return data[:end] + data[start:end] * rng.choice((1, 2, 20)) + data[end:]


def _take_over(data: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    other = rng.choice(others)
    (start, end), (first, last) = _span(data, rng), _span(other, rng)
    return data[:start] + other[first:last] + data[end:]


def _extreme(data: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    """Replace bytes by an extreme integer of a binary file."""
    start = rng.randrange(len(data) + 1)
    size = rng.choice((1, 2, 4, 8))
    number = rng.choice((b"\xff", b"\x00", b"\x7f", b"\x80")) * size
    return data[:start] + number + data[start + size :]


def _line(data: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
    """Remove, duplicate or move a line."""
    lines = data.split(b"\n")
    taken = lines.pop(rng.randrange(len(lines)))
    for _ in range(rng.choice((0, 1, 2))):
        lines.insert(rng.randrange(len(lines) + 1), taken)
    return b"\n".join(lines)


def _instead_of(pattern: "re.Pattern[bytes]", words: Sequence[bytes]) -> "Callable[..., bytes]":
    def change(data: bytes, others: Sequence[bytes], rng: random.Random) -> bytes:
        found = pattern.search(data, rng.randrange(len(data) + 1)) or pattern.search(data)
        if not found:
            return data
        start, end = found.span()
        return data[:start] + rng.choice(words) + data[end:]

    return change


_CHANGES = (
    _flip, _cut_out, _cut_off, _double, _take_over, _extreme, _line,
    _instead_of(NUMBER, NUMBERS), _instead_of(NUMBER, NUMBERS), _instead_of(NUMBER, NUMBERS),
    _instead_of(WORD, WORDS), _instead_of(WORD, NUMBERS),
)  # fmt: skip
