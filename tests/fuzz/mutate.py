"""Bytes that are nearly those of a sound file: as accidents and as ill will make them."""

from __future__ import annotations

import random
import re
import shutil
from pathlib import Path

NUMBERS = (b"nan", b"inf", b"-1", b"0", b"1e308", b"-1e308", b"9" * 20, b"1e9", b"0x10", b"1_000", b"2147483648")
WORDS = (
    b"\xff",
    b"\0",
    b"\xed\xa0\x80",
    b"{",
    b"[" * 80,
    b"&a ",
    b"*a",
    b"<<: ",
    b"\n",
    b'"',
    b"../",
    b"#",
    b"\xe2\x80\xae",
)
_NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:e-?\d+)?")


def mutated(content: bytes, rng: random.Random) -> bytes:
    """One to three changes."""
    for _ in range(rng.randint(1, 3)):
        content = rng.choice(_KINDS)(content, rng)
    return content[: 4 << 20]


def mutate_folder(source: Path, target: Path, rng: random.Random) -> None:
    """A copy of a folder with one of its files changed, cut off or gone."""
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(source, target)
    file = rng.choice(sorted(path for path in target.iterdir() if path.name != ".lock"))
    if rng.random() < 0.05:
        file.unlink()
    else:
        file.write_bytes(mutated(file.read_bytes(), rng))


def _flip(content: bytes, rng: random.Random) -> bytes:
    if not content:
        return content
    at = rng.randrange(len(content))
    return content[:at] + bytes([content[at] ^ 1 << rng.randrange(8)]) + content[at + 1 :]


def _cut(content: bytes, rng: random.Random) -> bytes:
    at = rng.randint(0, len(content))
    return content[:at] if rng.random() < 0.5 else content[:at] + content[min(len(content), at + rng.randint(1, 64)) :]


def _double(content: bytes, rng: random.Random) -> bytes:
    at = rng.randint(0, len(content))
    piece = content[at : at + rng.choice((1, 8, 64, 1000))]
    return content[:at] + piece * rng.choice((2, 2, 3, 300)) + content[at:]


def _insert(content: bytes, rng: random.Random) -> bytes:
    at = rng.randint(0, len(content))
    return content[:at] + rng.choice(WORDS + NUMBERS) + content[at:]


def _number(content: bytes, rng: random.Random) -> bytes:
    found = list(_NUMBER.finditer(content[:100_000]))
    if not found:
        return _insert(content, rng)
    match = rng.choice(found)
    return content[: match.start()] + rng.choice(NUMBERS) + content[match.end() :]


def _field(content: bytes, rng: random.Random) -> bytes:
    """A length or a count of a binary header."""
    if len(content) < 8:
        return content
    at = rng.randrange(min(len(content) - 4, 2000))
    value = rng.choice((0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, rng.getrandbits(32)))
    return content[:at] + value.to_bytes(4, "little") + content[at + 4 :]


_KINDS = (_flip, _cut, _double, _insert, _number, _number, _field)
