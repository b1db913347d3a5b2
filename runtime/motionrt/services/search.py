"""The service that searches: retrieve, similar, describe, moments, embed, build and update galleries."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property, partial
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, overload

import numpy as np

from motionrt.errors import GalleryError, GalleryNotFoundError, InvalidInputError
from motionrt.models.text import checked_text
from motionrt.models.tmr import TextMotionModel
from motionrt.motion import Motion
from motionrt.motion.skeleton import FloatArray
from motionrt.services.service import Service
from motionrt.untrusted.arguments import check_functions, check_kind, listed
from motionrt.untrusted.files import as_path
from motionrt.untrusted.words import shown

if TYPE_CHECKING:  # embedding a text, the shortest way to an answer, waits for none of these
    from motionrt.engines import GalleryStore, IndexReport
    from motionrt.retrieval import BuildReport, Description, EmbeddedCaptions, Gallery, Moments, Progress
    from motionrt.retrieval.filters import Filter
    from motionrt.retrieval.finding import Hits
    from motionrt.retrieval.ranking import Weights

    MotionLike = Motion | str | Path
    GalleryLike = Gallery | str | Path
    Library = Gallery | GalleryStore | str | Path

_ASSETS = Path(__file__).parents[1] / "_assets"
STARTER_GALLERY = _ASSETS / "starter"
DEFAULT_CAPTIONS = _ASSETS / "captions.txt"
EMBEDDED_CAPTIONS = _ASSETS / "captions.npz"  # the same, embedded by the shipped models, the full text tower


class Search(Service):
    """Galleries, text to motion, motion to text, and the embeddings behind both; its arguments are those of
    :class:`motionrt.Runtime`.
    """

    @cached_property
    def _galleries(self) -> dict[Path, tuple[int, Gallery]]:
        return {}

    @cached_property
    def _captions(self) -> dict[tuple[str, ...], EmbeddedCaptions]:
        return {}

    @cached_property
    def model(self) -> TextMotionModel:
        """The text and motion encoders."""
        return TextMotionModel(
            self.sessions, variant=self._variant, sentences=self.sentences, text_tower=self._text_tower
        )

    @overload  # a str is a sequence of str, too, so the two overlap
    def retrieve(  # type: ignore[overload-overlap]
        self,
        text: str,
        k: int = ...,
        gallery: Library | None = ...,
        *,
        per_clip: bool = ...,
        approximate: bool = ...,
        weights: Weights | None = ...,
        filter: Filter | None = ...,
        anyway: bool = ...,
    ) -> Hits: ...

    @overload
    def retrieve(
        self,
        text: Sequence[str],
        k: int = ...,
        gallery: Library | None = ...,
        *,
        per_clip: bool = ...,
        approximate: bool = ...,
        weights: Weights | None = ...,
        filter: Filter | None = ...,
        anyway: bool = ...,
    ) -> list[Hits]: ...

    def retrieve(
        self,
        text: str | Sequence[str],
        k: int = 10,
        gallery: Library | None = None,
        *,
        per_clip: bool = True,
        approximate: bool = False,
        weights: Weights | None = None,
        filter: Filter | None = None,  # noqa: A002 - the word that users look for
        anyway: bool = False,
    ) -> Hits | list[Hits]:
        """The motions of a gallery that fit a text best: by embedding, measured attributes and the library's words.

        Args:
            text: a sentence, or a list of them, which gives a list of answers.
            k: how many hits, at least 1; a smaller gallery gives all it has.
            gallery: a gallery or its folder; or a store, or its address (``"postgresql://user@host/database#library"``,
                ``"milvus://host:19530#library"``); by default the starter gallery that came with motionrt.
            per_clip: only the best span of every clip; otherwise every 10 s window is a hit of its own.
            approximate: search galleries of 50,000 windows and more by a graph of neighbours, which may miss a hit
                (extra ``ann``); see :meth:`Gallery.search`.
            weights: what each of the three counts; ``motionrt.retrieval.EMBEDDING_ONLY`` is the embedding alone.
            filter: which motions may be hits, as in ``Filter(where="turn > 60 and speed < 1.5", folder="walks")``.
            anyway: search even for a text of which no word is known; otherwise that gives no hits and a ``notice``.

        Raises:
            InvalidInputError: an empty text, a bad ``k``, or a condition that cannot be read.
            GalleryNotFoundError, GalleryError: no gallery there, damaged, or made by another model.
            EngineError: a database cannot be reached.
        """
        from motionrt.retrieval.filters import EVERYTHING
        from motionrt.retrieval.finding import Search, find
        from motionrt.retrieval.ranking import DEFAULT

        self.model.prepare()
        ranked, allowed = DEFAULT if weights is None else weights, EVERYTHING if filter is None else filter
        search = Search(k, per_clip, approximate, ranked, allowed, anyway)
        texts = _texts(text)
        store = self._store(gallery)
        if store is not None:
            from motionrt.engines import find_in

            hits = find_in(store, texts, self.model.embed_text(texts), search)
            return hits[0] if isinstance(text, str) else hits
        opened = self.gallery(gallery)  # type: ignore[arg-type]  # a store it is not
        opened.check_model(self.model.fingerprint, self.model.name)
        embedded = zip(texts, self.model.embed_text(texts), strict=True)
        hits = [find(opened, one, query, search) for one, query in embedded]
        return hits[0] if isinstance(text, str) else hits

    def similar(self, motion: MotionLike, k: int = 10, gallery: GalleryLike | None = None) -> Hits:
        """The clips of a gallery most like a motion, a motion file, or the gallery's own clip of that id (left out).

        Raises:
            InvalidInputError: a bad ``k``.
            MotionFileNotFoundError, FormatError, RigError: a file that cannot be read.
            GalleryNotFoundError, GalleryError: no gallery there, damaged, or made by another model.
        """
        from motionrt.retrieval.likeness import similar

        _check_motion(motion)
        opened = self.gallery(gallery)
        opened.check_model(self.model.fingerprint, self.model.name)
        own = opened.own(motion) if isinstance(motion, str | Path) else None
        return similar(opened, self.embed_motion(opened.motion(own) if own else motion), k, without=own)

    def gallery(self, gallery: GalleryLike | None = None) -> Gallery:
        """Open a gallery by its folder or the folder that was indexed; ``None`` is the starter gallery.

        An opened gallery is kept until the one on disk is replaced.
        """
        from motionrt.retrieval import GALLERY_FILE, Gallery, locate

        if isinstance(gallery, Gallery):
            return gallery
        folder = _starter() if gallery is None else locate(as_path(gallery))
        changed = (folder / GALLERY_FILE).stat().st_mtime_ns
        if self._galleries.get(folder, (None,))[0] != changed:
            self._galleries[folder] = changed, Gallery.open(folder, providers=self._providers)
        return self._galleries[folder][1]

    def _store(self, library: Library | None) -> GalleryStore | None:
        """The store that is meant, open and of the right model; None for a gallery."""
        from motionrt.retrieval import Gallery

        folder = isinstance(library, Path) or (isinstance(library, str) and "://" not in library)
        if folder or library is None or isinstance(library, Gallery):
            return None
        from motionrt.engines import GalleryStore, open_store

        if isinstance(library, str):
            store = self._stores[library] = self._stores.get(library) or open_store(library)
        elif isinstance(library, GalleryStore):
            store = library
        else:
            raise InvalidInputError(f"gallery must be a folder, a Gallery or a GalleryStore, not {shown(library)}")
        if store.model.fingerprint != self.model.fingerprint:
            raise GalleryError(
                f"the store's clips were embedded by the model {store.model.name}, not by {self.model.name}"
            )
        return store

    @cached_property
    def _stores(self) -> dict[str, GalleryStore]:
        return {}

    def describe(self, motion: MotionLike, k: int = 5, captions: Sequence[str] | None = None) -> list[Description]:
        """The captions that fit a motion best, out of a list.

        Args:
            motion: a motion or its file.
            k: how many, at least 1.
            captions: texts to choose from, by default a list of everyday actions that comes with motionrt. A
                list is embedded once and remembered.
        """
        from motionrt.motion.attributes import measure
        from motionrt.retrieval import describe, motion_features

        loaded, chosen = _loaded(motion), self.captions(captions)
        return describe(motion_features(loaded), loaded.duration, chosen, self.model, k, measure(loaded))

    def captions(self, texts: Sequence[str] | None = None) -> EmbeddedCaptions:
        """A list of captions, by default the one that comes with motionrt, with embeddings; remembered."""
        from motionrt.retrieval import checked_captions, read_captions

        chosen = checked_captions(texts if texts is not None else read_captions(DEFAULT_CAPTIONS))
        if chosen not in self._captions:
            self._captions[chosen] = self._embedded(chosen)
        return self._captions[chosen]

    def _embedded(self, texts: tuple[str, ...]) -> EmbeddedCaptions:
        from motionrt.retrieval import EmbeddedCaptions

        ready = EmbeddedCaptions.read(EMBEDDED_CAPTIONS, self.model.fingerprint)
        if ready is not None and ready.texts == texts:
            return ready
        return EmbeddedCaptions(texts, self.model.embed_text(texts), self.model.fingerprint)

    def moments(
        self,
        text: str,
        motion: MotionLike,
        k: int = 5,
        *,
        lengths: Sequence[int] | None = None,
        min_score: float | None = None,
    ) -> Moments:
        """Where in a motion a text happens: the best spans, and the similarity over time.

        ``lengths`` are those of the sliding windows, in frames at 20 fps; by default 10 to 60 (0.5 to 3 s).
        ``min_score``: only spans whose cosine with the text is at least this.
        """
        from motionrt.retrieval import WINDOW_LENGTHS, find_moments, motion_features

        query, chosen = self.embed_text(checked_text(text)), WINDOW_LENGTHS if lengths is None else lengths
        return find_moments(query, motion_features(_loaded(motion)), self.model, k, lengths=chosen, min_score=min_score)

    def embed_text(self, text: str | Sequence[str]) -> FloatArray:
        """Unit vector ``(256,)`` of a text, or ``(N, 256)`` of a list."""
        embeddings = self.model.embed_text(_texts(text))
        return embeddings[0] if isinstance(text, str) else embeddings

    def embed_motion(self, motion: MotionLike | Sequence[MotionLike]) -> FloatArray:
        """Unit vector ``(256,)`` of a motion or motion file, or ``(N, 256)`` of a list.

        A motion longer than 10 s is the mean over windows of 10 s, every 5 s, normalised.

        Raises:
            InvalidInputError: an empty list.
            MotionFileNotFoundError, FormatError, RigError: a file that cannot be read.
        """
        from motionrt.retrieval import embed_whole, motion_features

        if isinstance(motion, Motion | str | PathLike):
            return embed_whole(self.model, motion_features(_loaded(motion)))
        motions = listed(motion, "motion", "motions or files")
        if not motions:
            raise InvalidInputError("embed_motion needs at least one motion")
        return np.stack([embed_whole(self.model, motion_features(_loaded(one))) for one in motions])

    def build_gallery(
        self,
        folder: str | Path,
        out: str | Path | None = None,
        *,
        jobs: int = 1,
        mapping: Mapping[str, str] | None = None,
        fps: float | None = None,
        up: str | None = None,
        asf: str | Path | None = None,
        animation: int | str | None = None,
        progress: Progress | None = None,
        precision: str = "float32",
    ) -> BuildReport:
        """Index a folder of motion files; see :func:`motionrt.retrieval.build_gallery`.

        With ``jobs`` above 1 call it under ``if __name__ == "__main__":``, as for any Python that starts
        processes.
        """
        from motionrt.retrieval import build_gallery

        check_functions(progress=progress)
        return build_gallery(
            folder,
            self._opener(),
            out=out,
            jobs=jobs,
            mapping=mapping,
            fps=fps,
            up=up,
            asf=asf,
            animation=animation,
            progress=progress,
            precision=precision,
        )

    def update_gallery(self, gallery: str | Path, *, jobs: int = 1, progress: Progress | None = None) -> BuildReport:
        """Index what is new or changed, drop what is gone; see :func:`motionrt.retrieval.update_gallery`."""
        from motionrt.retrieval import update_gallery

        check_functions(progress=progress)
        return update_gallery(gallery, self._opener(), jobs=jobs, progress=progress)

    def index_into(
        self,
        folder: str | Path,
        address: str,
        *,
        on: str | None = None,
        mapping: Mapping[str, str] | None = None,
        fps: float | None = None,
        up: str | None = None,
        asf: str | Path | None = None,
        animation: int | str | None = None,
        progress: Progress | None = None,
    ) -> IndexReport:
        """Index a folder or object store into a database, on this machine or on a cluster.

        See :func:`motionrt.engines.index_into`; in an object store ``asf`` is a path below the folder.

        Raises:
            InvalidInputError, GalleryError, EngineError, MissingDependencyError: see there.
        """
        from motionrt.engines import index_into
        from motionrt.retrieval.build import checked_reading

        check_functions(progress=progress)
        check_kind(address, str, "address", "a str")
        check_kind(on, str | None, "on", "a str or None")
        source = None if isinstance(folder, str) and "://" in folder else as_path(folder).resolve()
        reading = checked_reading(source, mapping, fps, up, asf, animation)
        url = str(source or folder)
        return index_into(url, address, self._opener(), on=on, reading=reading, progress=progress)

    def _opener(self) -> partial[TextMotionModel]:
        """Opens the model with one thread: the same gallery, byte for byte, whatever builds it."""
        return partial(TextMotionModel, self._models, variant=self._variant, threads=1, providers=self._providers)


def _starter() -> Path:
    from motionrt.retrieval import GALLERY_FILE

    if not (STARTER_GALLERY / GALLERY_FILE).is_file():
        raise GalleryNotFoundError(
            f"the starter gallery is not installed ({STARTER_GALLERY}); "
            "build one of your own with: motionrt gallery build FOLDER"
        )
    return STARTER_GALLERY


def _texts(text: str | Sequence[str]) -> list[str]:
    texts = [text] if isinstance(text, str) else listed(text, "text", "texts")
    if not texts:
        raise InvalidInputError("give at least one text")
    return texts


def _check_motion(motion: object) -> None:
    check_kind(motion, (Motion, str, PathLike), "motion", "a Motion or a file")


def _loaded(motion: MotionLike) -> Motion:
    from motionrt.formats import load_motion

    _check_motion(motion)
    return motion if isinstance(motion, Motion) else load_motion(motion)
