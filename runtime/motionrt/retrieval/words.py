"""The words that a library carries about its clips: captions, tags and file names, ranked as BM25 ranks documents.

Robertson and Zaragoza, The Probabilistic Relevance Framework: BM25 and Beyond, 2009, eq. 3.15; a document is a window.
"""

from __future__ import annotations

import re
import unicodedata
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property, lru_cache
from pathlib import PurePosixPath
from typing import Any

import numpy as np
import numpy.typing as npt

from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval.records import Caption, Clip, WindowTable
from motionrt.retrieval.strings import Strings
from motionrt.untrusted import Fail
from motionrt.untrusted.safetensors import Columns, checked

Array = npt.NDArray[Any]
_KINDS: dict[str, tuple[str, tuple[int | None, ...]]] = {
    "words": ("U8", (None,)),
    "word_ends": ("I64", (None,)),
    "starts": ("I64", (None,)),
    "windows": ("U32", (None,)),
    "counts": ("U16", (None,)),
    "lengths": ("U32", (None,)),
}
_K1, _B = 1.2, 0.5
_WORTH = (_K1 + 1) / (1 + _K1)  # of a word that stands once in a window of the usual length
_MOST = 65535  # how often a word may count in a window
_WORD = re.compile(r"[^\W\d_]+")
_SAYS_NOTHING = """
a an the and or of to in on at by for with from into onto while then as is are was were be been being it its his her
their he she they them him this that these those who which some someone somebody person people man woman guy boy girl
human character figure subject actor performer do does doing make makes making very quite just motion animation clip
mocap anim take bvh amc glb npz fbx
"""
STOP = frozenset(_SAYS_NOTHING.split())
"""Words that say nothing about a motion."""


def stems(text: str) -> list[str]:
    """The telling words of a text: lower case, without accents, endings and what says nothing."""
    letters = unicodedata.normalize("NFKD", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)).lower()
    plain = "".join(letter for letter in letters if not unicodedata.combining(letter))
    return [stem(word) for word in _WORD.findall(plain) if len(word) > 1 and word not in STOP]


@lru_cache(maxsize=65536)
def stem(word: str) -> str:
    """A word without the endings of verbs and nouns: "waving" and "waves" are "wav"."""
    for ending in ("ing", "ed", "es", "s", "e"):
        if word.endswith(ending) and len(word) - len(ending) >= 3 and not word.endswith("ss"):
            word = word[: -len(ending)]
            if ending in ("ing", "ed") and word[-1] == word[-2] and word[-1] not in "sl":
                word = word[:-1]
            break
    return word[:-1] + "i" if word.endswith("y") and len(word) > 3 else word


class Postings:
    """Which windows carry which words, how often, and how many words each carries.

    Args:
        words: all different ones, in order.
        starts: ``(V + 1,)`` where the entries of a word begin.
        windows: ``(P,)`` windows, word by word.
        counts: ``(P,)`` how often the word stands there.
        lengths: ``(W,)`` words of each window.
    """

    def __init__(self, words: Strings, starts: Array, windows: Array, counts: Array, lengths: Array) -> None:
        self.words, self.starts = words, starts
        self.windows, self.counts, self.lengths = windows, counts, lengths

    @classmethod
    def of(
        cls, clips: Sequence[Clip], windows: WindowTable, captions: Iterable[Caption], *, names: bool = True
    ) -> Postings:
        """The words of captions, of clips' texts and, unless told otherwise, of file names.

        A caption of a part of a clip belongs to the windows that it overlaps by half of the shorter.
        """
        found: dict[str, list[tuple[int, int]]] = defaultdict(list)
        lengths = np.zeros(len(windows), np.uint32)
        for window, words in enumerate(_documents(clips, windows, captions, names)):
            lengths[window] = len(words)
            for word, often in Counter(words).items():
                found[word].append((window, min(often, _MOST)))
        ordered = sorted(found, key=lambda word: word.encode("utf-8", "surrogatepass"))
        entries = np.array([entry for word in ordered for entry in found[word]], np.uint32).reshape(-1, 2)
        starts = np.cumsum([0, *(len(found[word]) for word in ordered)], dtype=np.int64)
        return cls(Strings.of(ordered), starts, entries[:, 0].copy(), entries[:, 1].astype(np.uint16), lengths)

    @classmethod
    def of_columns(cls, columns: Columns, windows: int, fail: Fail) -> Postings:
        """Those of a file, of so many windows, with all numbers in their bounds."""
        column = checked(columns, _KINDS, fail)
        starts, places, ends = column("starts"), column("windows"), column("word_ends")
        words = Strings(column("words"), ends).check(fail, len(ends))
        fits = len(starts) == len(words) + 1 and starts[0] == 0 and len(places) == len(column("counts")) == starts[-1]
        fits = fits and bool((np.diff(starts) >= 0).all()) and len(column("lengths")) == windows
        if not fits or (len(places) and places.max() >= windows):
            raise fail("is damaged (its words are not of its windows)", None)
        return cls(words, starts, places, column("counts"), column("lengths"))

    def columns(self) -> Columns:
        """What a file holds of them."""
        return {
            "words": self.words.content,
            "word_ends": self.words.ends,
            "starts": self.starts,
            "windows": self.windows,
            "counts": self.counts,
            "lengths": self.lengths,
        }

    def among(self, chosen: npt.NDArray[np.integer[Any]]) -> Postings:
        """Those of some windows, ascending, which are counted anew."""
        place = np.full(len(self.lengths), -1, np.int64)
        place[chosen] = np.arange(len(chosen))
        kept = np.flatnonzero(place[self.windows] >= 0)
        starts = np.searchsorted(kept, self.starts)
        return Postings(self.words, starts, place[self.windows[kept]], self.counts[kept], self.lengths[chosen])

    def entries(self, word: str) -> tuple[Array, Array]:
        """The windows that carry a word, and how often."""
        number = self.words.find(word)
        part = slice(0, 0) if number is None else slice(int(self.starts[number]), int(self.starts[number + 1]))
        return self.windows[part], self.counts[part]


class WordIndex:
    """The words of a library: those of all its parts together.

    Args:
        parts: the words of each part, whose windows stand one part behind the other.
    """

    def __init__(self, parts: Sequence[Postings]) -> None:
        self._parts = parts
        self._firsts = np.cumsum([0, *(len(part.lengths) for part in parts)]).tolist()
        self.count = self._firsts[-1]
        total = sum(int(part.lengths.sum(dtype=np.int64)) for part in parts)
        self._usual = max(total / max(self.count, 1), 1.0)

    @classmethod
    def of(
        cls, clips: Sequence[Clip], windows: WindowTable, captions: Iterable[Caption], *, names: bool = True
    ) -> WordIndex:
        """The words of clips and their captions; see :meth:`Postings.of`."""
        return cls([Postings.of(clips, windows, captions, names=names)])

    def known(self, text: str) -> list[str]:
        """The words of a text that some window carries."""
        return [word for word in dict.fromkeys(stems(text)) if any(len(part.entries(word)[0]) for part in self._parts)]

    def scores(self, text: str) -> FloatArray | None:
        """``(W,)`` from 0 (no word of the text) to about 1 (all of them); None where no window has any."""
        asked = list(dict.fromkeys(stems(text)))
        known = self.known(text)
        if not known:
            return None
        total = np.zeros(self.count, dtype=np.float32)
        most = 0.0
        for word in known:
            found = [part.entries(word) for part in self._parts]
            rare = self._rarity(sum(len(windows) for windows, _ in found))
            most += rare * _WORTH
            for part, first, (windows, counts) in zip(self._parts, self._firsts, found, strict=False):
                often, length = counts.astype(np.float64), part.lengths[windows] / self._usual
                weight = rare * often * (_K1 + 1) / (often + _K1 * (1 - _B + _B * length))
                total[first + windows.astype(np.int64)] += weight.astype(np.float32)
        if unknown := len(asked) - len(known):
            most += unknown * _WORTH * self._rarity(self._rarest)
        return np.asarray(np.minimum(total / max(most, 1e-6), 1.0), dtype=np.float32)

    def having(self, text: str) -> npt.NDArray[np.bool_]:
        """``(W,)`` which windows carry every word of a text that tells anything."""
        found = np.ones(self.count, dtype=bool)
        for word in dict.fromkeys(stems(text)):
            have = np.zeros(self.count, dtype=bool)
            for part, first in zip(self._parts, self._firsts, strict=False):
                have[first + part.entries(word)[0].astype(np.int64)] = True
            found &= have
        return found

    @cached_property
    def _rarest(self) -> int:
        """How many windows carry the rarest word that any carries."""
        often = [np.diff(part.starts) for part in self._parts]
        if len(often) > 1:
            words = [word for part in self._parts for word in part.words.pieces()]
            numbers = {word: number for number, word in enumerate(dict.fromkeys(words))}
            often = [np.bincount([numbers[word] for word in words], np.concatenate(often))]
        return int(min((part[part > 0].min(initial=self.count) for part in often), default=self.count))

    def _rarity(self, windows: int) -> float:
        """What a word that so many windows carry is worth."""
        return float(np.log(1 + (self.count - windows + 0.5) / (windows + 0.5)))


def _documents(
    clips: Sequence[Clip], windows: WindowTable, captions: Iterable[Caption], names: bool
) -> Iterator[list[str]]:
    """The words of every window."""
    about: dict[str, list[Caption]] = defaultdict(list)
    for caption in captions:
        about[caption.clip].append(caption)
    owners, starts, ends = (windows[field].tolist() for field in ("clip", "start_s", "end_s"))
    now, clip, words = -1, None, []
    for owner, start, end in zip(owners, starts, ends, strict=True):
        if owner != now:
            now, clip = owner, clips[owner]
            words = (_named(clip) if names else []) + stems(clip.text or "")
        own = [caption for caption in about.get(clip.id, ()) if _overlaps(caption, start, end)] if clip else []
        yield words + [word for caption in own for word in stems(" ".join((caption.text, *caption.tags)))]


def _named(clip: Clip) -> list[str]:
    """The words of a clip's path and of its animation's name."""
    return stems(f"{PurePosixPath(clip.file).with_suffix('')} {clip.animation or ''}")


def _overlaps(caption: Caption, start_s: float, end_s: float) -> bool:
    first = caption.start_s if caption.start_s is not None else start_s
    last = caption.end_s if caption.end_s is not None else end_s
    shared = min(last, end_s) - max(first, start_s)
    return shared > 0 and shared >= 0.5 * min(last - first, end_s - start_s)
