"""``Gallery``: the embeddings of a motion library, on disk and memory-mapped."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from itertools import islice
from pathlib import Path

import numpy as np

from motionrt.errors import GalleryError, InvalidInputError
from motionrt.formats.motion_pack import MotionPack
from motionrt.models.engine import Providers
from motionrt.motion import Motion
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import editing, layout, store
from motionrt.retrieval.contents import Contents
from motionrt.retrieval.joined_index import JoinedIndex
from motionrt.retrieval.locking import writing
from motionrt.retrieval.records import Clip, ModelStamp, window_table
from motionrt.retrieval.scores import IntArray
from motionrt.retrieval.search import ExactIndex, Hit, Mask, VectorIndex, checked_k, nearest_per_group
from motionrt.retrieval.segments import words_of
from motionrt.retrieval.vectors import Block, Blocks
from motionrt.retrieval.windows import MotionEmbedder, embed_windows, measured, motion_features, spans_in_seconds
from motionrt.retrieval.words import WordIndex
from motionrt.untrusted.arguments import check_flags, check_kind, checked_array, checked_whole, listed
from motionrt.untrusted.files import as_path
from motionrt.untrusted.words import shown

_UPDATE = "motionrt gallery update"


@dataclass(frozen=True, eq=False)
class Gallery(Contents):
    """Clips, and the embeddings of their windows (10 s long, every 5 s; a shorter clip is one window).

    Attributes:
        clips: ``N`` clips, a sequence; ordered by id in a gallery that was built or compacted, and after updates within
            each segment.
        embeddings: ``(W, 256)`` float32 unit vectors, memory-mapped when opened from disk. Those of a gallery of
            several segments, or of fewer bits, behave as such an array and are read where they are asked for.
        windows: ``(W,)`` records of clip number, ``start_s`` and ``end_s``, in the order of the clips.
        model: which model made the embeddings; only the same model may search them.
        source: the folder that was indexed, ``None`` when the clips are not files.
        skipped: files of that folder that could not be indexed.
        reading: how the files were read: joint mapping, frame rate, vertical axis.
        motions: the clips themselves, or the file that holds them, when the gallery carries them.
        folder: where the gallery was opened or saved, ``None`` for one in memory.
        providers: onnxruntime's execution providers of the 8-bit scan, the preferred one first; None is the CPU.
        neighbours: where the index of approximate search is kept, ``None`` for a gallery in memory.
        attributes: ``(W, A)`` float32, what each window does (:data:`motionrt.motion.attributes.ATTRIBUTES`), ``None``
            in a gallery of an older motionrt until it is updated.
        captions: words that the library carries about its clips.
        precision: what embeddings are stored in: ``float32``, ``float16`` or ``int8``.
        sidecars: size and time of the files that the captions were read from.
        stored: the segments that it was read from, none in memory; :attr:`segments` gives those of any gallery.
    """

    providers: Providers | None = None

    def __len__(self) -> int:
        return len(self.clips)

    def __repr__(self) -> str:
        place = f" in {self.folder}" if self.folder else ""
        return f"Gallery({len(self)} clips, {len(self.windows)} windows{place})"

    @classmethod
    def open(cls, path: str | Path, *, providers: Providers | None = None) -> Gallery:
        """Open a gallery folder, or the gallery of an indexed folder.

        ``providers`` are onnxruntime's execution providers of the 8-bit scan, by default the CPU.

        Raises:
            GalleryNotFoundError: there is none; the message gives the command that builds it.
            GalleryError: it is damaged or of another version.
        """
        found = layout.read(store.locate(as_path(path)))
        return cls(**{field.name: getattr(found, field.name) for field in fields(found)}, providers=providers)

    @classmethod
    def from_motions(
        cls,
        motions: Sequence[Motion],
        ids: Sequence[str],
        model: MotionEmbedder,
        *,
        texts: Sequence[str] | None = None,
        store_motions: bool = True,
    ) -> Gallery:
        """A gallery of motions in memory, in the order of their ids; :meth:`save` writes it.

        Args:
            motions: at least one motion of ``smpl24``.
            ids: a name for each, all different.
            model: the model that embeds them.
            texts: what each shows.
            store_motions: carry the motions inside the gallery, so that hits can be saved anywhere.
        """
        motions, ids = listed(motions, "motions", "Motions"), listed(ids, "ids", "texts")
        texts = None if texts is None else listed(texts, "texts", "texts")
        check_flags(store_motions=store_motions)
        for motion in motions:
            check_kind(motion, Motion, "each of motions", "a Motion")
        for name in (*ids, *(texts or ())):
            check_kind(name, str, "each of ids and texts", "a str")
        if not callable(getattr(model, "embed_motion", None)):
            raise InvalidInputError(f"model must embed motions, as Runtime.model does, not {shown(model)}")
        if not motions or len(set(ids)) != len(motions) or len(texts or ids) != len(ids):
            raise InvalidInputError("a gallery needs motions, and as many different ids and texts")
        order = sorted(range(len(ids)), key=lambda i: ids[i])
        embedded = [embed_windows(model, motion_features(motions[i])) for i in order]
        clips = [Clip(ids[i], motions[i].duration, text=texts[i] if texts else None) for i in order]
        spans = [spans_in_seconds(frames, clip.duration_s) for (_, frames), clip in zip(embedded, clips, strict=True)]
        return cls(
            tuple(clips),
            np.concatenate([embeddings for embeddings, _ in embedded]),
            window_table(spans),
            ModelStamp(model.name, model.fingerprint),
            motions=MotionPack.of([motions[i] for i in order]) if store_motions else None,
            attributes=np.concatenate([measured(motions[i], part) for i, part in zip(order, spans, strict=True)]),
        )

    def save(self, folder: str | Path) -> Gallery:
        """Write the gallery to ``folder``, replacing the one there in one step; returns it as opened there.

        Raises:
            GalleryError: the folder cannot be written, or another process is writing there.
        """
        folder = as_path(folder)
        with writing(folder):
            layout.save(self, folder)
        return Gallery.open(folder)

    def append(self, other: Gallery) -> Gallery:
        """Add the clips of another gallery, with new ids, to this one's folder; returns it as it is there now.

        Raises:
            InvalidInputError: an id is taken, only one of the two carries its motions, or this gallery has no folder.
            GalleryError: another model embedded them, the folder cannot be written, or another process writes there.
        """
        editing.append(self._own_folder(), other)
        return Gallery.open(self._own_folder(), providers=self.providers)

    def delete(self, ids: Iterable[str]) -> Gallery:
        """Take clips out of this gallery's folder, though not their files; returns it as it is there now.

        The next update of a gallery that was made from files finds them again, unless the files are gone.

        Raises:
            InvalidInputError: no such clip, none would be left, or this gallery has no folder.
            GalleryError: the folder cannot be written, or another process writes there.
        """
        editing.delete(self._own_folder(), ids)
        return Gallery.open(self._own_folder(), providers=self.providers)

    def compact(self, precision: str | None = None) -> Gallery:
        """Write this gallery's folder as one segment, which drops what was deleted; returns it as it is there now.

        Args:
            precision: store embeddings in ``float32``, ``float16`` or ``int8`` from now on, by default as they are.

        Raises:
            InvalidInputError: no such precision, or this gallery has no folder.
            GalleryError: a file is damaged, the folder cannot be written, or another process writes there.
        """
        editing.compact(self._own_folder(), precision)
        return Gallery.open(self._own_folder(), providers=self.providers)

    def _own_folder(self) -> Path:
        if self.folder is None:
            raise InvalidInputError("this gallery is in memory: save it first")
        return self.folder

    def verify(self) -> None:
        """Read the gallery's files in full and check their checksums; GalleryError names a damaged one."""
        if self.folder is not None:
            layout.verify(self.folder)

    def check_model(self, fingerprint: str, name: str) -> None:
        """GalleryError unless the model with that fingerprint made this gallery."""
        check_kind(fingerprint, str, "fingerprint", "a str")
        if fingerprint == self.model.fingerprint:
            return
        which = f"the gallery {self.folder}" if self.folder else "the gallery"
        raise GalleryError(
            f"{which} was made by the model {self.model.name} ({self.model.fingerprint[:12]}), not by {name} "
            f"({fingerprint[:12]}); build it again: {self._build_command()}"
        )

    def search(self, query: FloatArray, k: int = 10, *, per_clip: bool = True, approximate: bool = False) -> list[Hit]:
        """The ``min(k, N)`` best hits for a unit vector ``(256,)``, best first, exact unless told otherwise.

        Args:
            query: an embedding by the gallery's model (:meth:`check_model`).
            k: how many, at least 1.
            per_clip: only the best window of every clip; otherwise every window is a hit of its own.
            approximate: look only where the best are likely, which pays in galleries of hundreds of thousands of
                windows (a smaller one is searched exactly). The index for it is built at the first such search, or by
                :meth:`prepare`, and kept beside the gallery. The scores are exact.

        Raises:
            InvalidInputError: a query of another shape or not finite, or a bad ``k``.
            MissingDependencyError: ``approximate`` without the package that it needs.
        """
        k = checked_k(k)
        check_flags(per_clip=per_clip, approximate=approximate)
        query = _as_query(query)
        if query.shape != self.embeddings.shape[1:]:
            raise InvalidInputError(f"a query is a vector of {self.embeddings.shape[1]}, not {query.shape}")
        index = self._approximate if approximate else self._exact
        if per_clip:
            found, scores = nearest_per_group(index, query, k, self.windows["clip"])
        else:
            found, scores = index.nearest(query, k)
        return [self.hit(rank, int(i), float(s)) for rank, (i, s) in enumerate(zip(found, scores, strict=True), 1)]

    def prepare(self, *, approximate: bool = False) -> Gallery:
        """Get ready for many searches now, so that none of them waits; gives the gallery itself.

        Exact search is made faster by a copy in 8 bits a number (some 2 s for a million windows), approximate search
        needs its index (minutes for a million windows, once).

        Raises:
            MissingDependencyError: ``approximate`` without the package that it needs.
        """
        check_flags(approximate=approximate)
        (self._approximate if approximate else self._exact).prepare()
        return self

    def _repr_html_(self) -> str:
        """The first clips as a table with pictures, for notebooks."""
        from motionrt.motion.notebook import PICTURED, page, table

        first = list(islice(self.clips, PICTURED))
        rows = [[clip.id, f"{clip.duration_s:.1f} s"] for clip in first]
        return page(repr(self), table(("clip", "length"), rows), *(self.sketch(clip.id) for clip in first))

    def sketch(self, hit: Hit | str) -> str:
        """SVG strip of a hit or of a whole clip, under its name; only the name where the file cannot be read."""
        from motionrt.errors import MotionRTError
        from motionrt.motion.notebook import page, strip

        name = hit if isinstance(hit, str) else hit.id
        try:
            return page(name, strip(self.motion(hit)))
        except MotionRTError as error:
            return page(f"{name}: {error}")

    def own(self, motion: str | Path) -> str | None:
        """The id of the clip of that id (``str``) or that file (``Path``); None where it is none of the gallery's."""
        name = str(motion)
        if isinstance(motion, Path):
            if self.source is None or not motion.is_relative_to(self.source):
                return None
            name = motion.relative_to(self.source).as_posix()
        return None if self._number(name) is None else name

    def path(self, clip: Clip) -> Path | None:
        """The clip's file, ``None`` when it has none."""
        return self.source / clip.file if self.source is not None and clip.is_file else None

    def motion(self, hit: Hit | str) -> Motion:
        """The motion of a hit, cut to its span, or of a whole clip by its id.

        Raises:
            InvalidInputError: no clip with that id.
            GalleryError: the gallery carries neither the motion nor a file's name; or the file lies outside of the
                gallery's surroundings and is not the one that was indexed.
            MotionFileNotFoundError, FormatError: the clip's file is gone, or broken now.
        """
        clip_id = hit if isinstance(hit, str) else getattr(hit, "id", hit)
        number = self._number(clip_id) if isinstance(clip_id, str) else None
        if number is None:
            raise InvalidInputError(f"no clip {shown(clip_id)} in this gallery")
        motion = self._load(number)
        return motion if isinstance(hit, str) else motion.between(hit.start_s, hit.end_s)

    def _build_command(self) -> str:
        out = f' -o "{self.folder}"' if self.folder and self.folder.name != store.DEFAULT_FOLDER else ""
        return f'motionrt gallery build "{self.source or "FOLDER"}"{out}'

    def _load(self, number: int) -> Motion:
        if self.pack is not None:
            return self.pack[number]
        clip = self.clips[number]
        path = self.path(clip)
        if path is None:
            raise GalleryError(f"the motion of '{clip.id}' is not in the gallery, only its embedding")
        self._check_foreign(clip, path)
        from motionrt.formats import load_motion  # its readers are slow to import

        return load_motion(path, **self.reading.arguments(self.source or path.parent, clip.animation))

    def _check_foreign(self, clip: Clip, path: Path) -> None:
        """Of files that lie elsewhere only those are read that were indexed: a strange gallery names no others.

        Raises:
            GalleryError: the file is another one than was indexed.
        """
        inside = self.folder is not None and self.source is not None and self.folder.is_relative_to(self.source)
        if not inside and path.is_file() and store.digest(path) != clip.sha256:
            raise GalleryError(f"{path} is not the file that was indexed; bring the gallery up to date: {_UPDATE}")

    def nearest(
        self, query: FloatArray, count: int, *, approximate: bool = False, allowed: Mask | None = None
    ) -> IntArray:
        """The ``count`` windows nearest to a unit vector ``(256,)``, best first, or all there are.

        Args:
            query: an embedding by the gallery's model.
            count: how many, at least 1.
            approximate: see :meth:`search`.
            allowed: ``(W,)`` which windows may be found, by default all.

        Raises:
            InvalidInputError: a query of another shape or not finite, or ``allowed`` of another shape.
            MissingDependencyError: ``approximate`` without the package that it needs.
        """
        check_flags(approximate=approximate)
        count, query = checked_whole(count, "count", 1), _as_query(query)
        if query.shape != self.embeddings.shape[1:]:
            raise InvalidInputError(f"a query is a vector of {self.embeddings.shape[1]}, not {query.shape}")
        index = self._approximate if approximate else self._exact
        return index.nearest(query, count, None if allowed is None else self._checked_mask(allowed))[0]

    def _checked_mask(self, allowed: object) -> Mask:
        """Which windows may be found; InvalidInputError unless it says yes or no of each."""
        if isinstance(allowed, np.ndarray) and allowed.dtype == np.bool_ and allowed.shape == (len(self.windows),):
            return allowed
        raise InvalidInputError(f"allowed must be an array of {len(self.windows)} booleans, not {shown(allowed)}")

    def hit(
        self, rank: int, window: int, score: float, cosine: float | None = None, agreement: float | None = None
    ) -> Hit:
        """The window of that number as a hit."""
        row = self.windows[window]
        clip = self.clips[int(row["clip"])]
        start, end = float(row["start_s"]), float(row["end_s"])
        return Hit(rank, score, clip.id, self.path(clip), start, end, clip.text, cosine, agreement)

    @property
    def duration_s(self) -> float:
        """How long all clips last together, seconds."""
        kept = [(part.clips.duration_s, part.kept_clips) for part in self.segments]
        return float(sum((seconds if some is None else seconds[some]).sum() for seconds, some in kept))

    @cached_property
    def words(self) -> WordIndex:
        """The words of captions, texts and file names; read, or found, when first needed."""
        return words_of(self.segments)

    @cached_property
    def tags(self) -> dict[str, frozenset[str]]:
        """Clip id -> its tags, lower case."""
        found: dict[str, frozenset[str]] = {}
        for caption in self.captions:
            tags = frozenset(tag.lower() for tag in caption.tags)
            found[caption.clip] = found.get(caption.clip, frozenset()) | tags
        return found

    @cached_property
    def _exact(self) -> VectorIndex:
        layout.check_for_search(self)
        return self._index(lambda block: ExactIndex(block.vectors, providers=self.providers))

    @cached_property
    def _approximate(self) -> VectorIndex:
        from motionrt.retrieval.approximate import ApproximateIndex

        exact = self._exact
        parts = iter(exact.indexes if isinstance(exact, JoinedIndex) else [exact])
        return self._index(lambda block: ApproximateIndex(block.vectors, next(parts), block.neighbours))

    def _index(self, make: Callable[[Block], VectorIndex]) -> VectorIndex:
        """An index of the embeddings, made of those of their blocks."""
        if isinstance(self.embeddings, Blocks):
            return JoinedIndex(self.embeddings.blocks, make)
        return make(Block(self.embeddings, neighbours=self.neighbours))

    def _number(self, clip_id: str) -> int | None:
        """The number of a clip."""
        first = 0
        for part in self.segments:
            number = part.clips.number(clip_id)
            if number is not None and part.kept_clips is not None:
                place = int(np.searchsorted(part.kept_clips, number))
                kept = place < len(part.kept_clips) and part.kept_clips[place] == number
                number = place if kept else None
            if number is not None:
                return first + number
            first += part.clip_count
        return None


def _as_query(query: object) -> FloatArray:
    with np.errstate(over="ignore"):  # infinity is refused by the search
        return checked_array(query, "a query", "a vector of numbers").astype(np.float32)
