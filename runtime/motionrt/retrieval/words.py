"""The words that a library carries about its clips: captions, tags and file names, ranked as BM25 ranks documents.

Robertson and Zaragoza, The Probabilistic Relevance Framework: BM25 and Beyond, 2009, eq. 3.15; a document is a window.
"""

from __future__ import annotations

import re
import unicodedata
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import IO

import numpy as np
import numpy.typing as npt

from motionrt.errors import FormatError
from motionrt.retrieval.records import Caption, Clip, WindowTable
from motionrt.untrusted.npz import read_arrays

Array = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.int32]
_KINDS = {"words": np.uint8, "starts": np.int32, "windows": np.int32, "weights": np.float32, "worth": np.float32}
_K1, _B = 1.2, 0.5
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


@dataclass(frozen=True, eq=False)
class WordIndex:
    """Which windows carry which words, and how much that says.

    Attributes:
        words: word -> its number.
        starts: ``(V + 1,)`` where the entries of a word begin.
        windows: ``(P,)`` windows, word by word.
        weights: ``(P,)`` what the word is worth there.
        worth: ``(V,)`` what a word is worth at most.
        count: number of windows.
    """

    words: dict[str, int]
    starts: IntArray
    windows: IntArray
    weights: Array
    worth: Array
    count: int

    @classmethod
    def of(
        cls, clips: Sequence[Clip], windows: WindowTable, captions: Iterable[Caption], *, names: bool = True
    ) -> WordIndex:
        """The words of captions, of clips' texts and, unless told otherwise, of file names.

        A caption of a part of a clip belongs to the windows that it overlaps by half of the shorter.
        """
        said = _documents(clips, windows, captions, names)
        counts = [Counter(words) for words in said]
        length = np.array([len(words) for words in said], dtype=np.float64)
        usual = max(float(length.mean()), 1.0)
        found: dict[str, list[tuple[int, int]]] = defaultdict(list)
        for window, words in enumerate(counts):
            for word, often in words.items():
                found[word].append((window, often))
        return cls._packed(found, length / usual, len(said))

    @classmethod
    def _packed(cls, found: dict[str, list[tuple[int, int]]], length: npt.NDArray[np.float64], count: int) -> WordIndex:
        starts, windows, weights, worth = [0], [], [], []
        for entries in found.values():
            place, often = np.array(entries, dtype=np.int32).T
            rare = np.log(1 + (count - len(place) + 0.5) / (len(place) + 0.5))
            weight = rare * often * (_K1 + 1) / (often + _K1 * (1 - _B + _B * length[place]))
            starts.append(starts[-1] + len(place))
            windows.append(place)
            weights.append(weight.astype(np.float32))
            worth.append(rare * (_K1 + 1) / (1 + _K1 * (1 - _B + _B)))
        joined = [np.concatenate(parts) if parts else np.zeros(0) for parts in (windows, weights)]
        numbers = {word: k for k, word in enumerate(found)}
        return cls(
            numbers, np.array(starts, np.int32), joined[0].astype(np.int32), joined[1].astype(np.float32),
            np.array(worth, np.float32), count,
        )  # fmt: skip

    def write(self, file: IO[bytes]) -> None:
        """Write the index as ``.npz``."""
        words = np.frombuffer("\n".join(self.words).encode("utf-8"), dtype=np.uint8)
        np.savez(file, words=words, starts=self.starts, windows=self.windows, weights=self.weights, worth=self.worth)

    @classmethod
    def read(cls, path: Path, count: int) -> WordIndex | None:
        """What :meth:`write` wrote for ``count`` windows; None where the file is damaged: it can be made again."""
        try:
            found, _ = read_arrays(path, lambda reason, line: FormatError(path, reason, line), tuple(_KINDS))
        except (OSError, FormatError):
            return None
        if set(found) != set(_KINDS) or any(a.ndim != 1 or a.dtype != _KINDS[name] for name, a in found.items()):
            return None
        words, starts, windows, weights, worth = (found[name] for name in _KINDS)
        listed = words.tobytes().decode("utf-8", "replace").split("\n") if len(words) else []
        numbers = {word: k for k, word in enumerate(listed)}
        fits = len(numbers) == len(worth) == len(starts) - 1 and len(windows) == len(weights) == starts[-1]
        fits = fits and starts[0] == 0 and bool((np.diff(starts) >= 0).all())
        fits = fits and 0 <= windows.min(initial=0) <= windows.max(initial=-1) + 1 <= count
        return cls(numbers, starts, windows, weights, worth, count) if fits else None

    def known(self, text: str) -> list[str]:
        """The words of a text that some clip carries."""
        return [word for word in dict.fromkeys(stems(text)) if word in self.words]

    def scores(self, text: str) -> Array | None:
        """``(W,)`` from 0 (no word of the text) to about 1 (all of them); None where no window has any."""
        asked = list(dict.fromkeys(stems(text)))
        known = [self.words[word] for word in asked if word in self.words]
        if not known:
            return None
        total = np.zeros(self.count, dtype=np.float32)
        for number in known:
            part = slice(self.starts[number], self.starts[number + 1])
            total[self.windows[part]] += self.weights[part]
        unknown = len(asked) - len(known)
        most = float(self.worth[known].sum()) + unknown * float(self.worth.max(initial=0.0))
        return np.asarray(np.minimum(total / max(most, 1e-6), 1.0), dtype=np.float32)


def _documents(
    clips: Sequence[Clip], windows: WindowTable, captions: Iterable[Caption], names: bool
) -> list[list[str]]:
    about: dict[str, list[Caption]] = defaultdict(list)
    for caption in captions:
        about[caption.clip].append(caption)
    whole = [
        (stems(f"{PurePosixPath(clip.file).with_suffix('')} {clip.animation or ''}") if names else [])
        + stems(clip.text or "")
        for clip in clips
    ]
    said = []
    for row in windows:
        clip = clips[int(row["clip"])]
        own = [c for c in about.get(clip.id, ()) if _overlaps(c, float(row["start_s"]), float(row["end_s"]))]
        said.append(whole[int(row["clip"])] + [word for c in own for word in stems(" ".join((c.text, *c.tags)))])
    return said


def _overlaps(caption: Caption, start_s: float, end_s: float) -> bool:
    first = caption.start_s if caption.start_s is not None else start_s
    last = caption.end_s if caption.end_s is not None else end_s
    shared = min(last, end_s) - max(first, start_s)
    return shared > 0 and shared >= 0.5 * min(last - first, end_s - start_s)
