"""Search a motion library: galleries, text to motion, motion to text, moments."""

from __future__ import annotations

from typing import TYPE_CHECKING

from motionrt._lazy import lazily

if TYPE_CHECKING:
    from motionrt.retrieval.assembly import BuildReport, Progress
    from motionrt.retrieval.build import build_gallery, update_gallery
    from motionrt.retrieval.captions import EmbeddedCaptions, checked_captions, read_captions
    from motionrt.retrieval.describing import Description, describe
    from motionrt.retrieval.filters import Filter
    from motionrt.retrieval.finding import Hits, Search, find, grouped
    from motionrt.retrieval.gallery import Gallery
    from motionrt.retrieval.likeness import Duplicates, duplicates, similar
    from motionrt.retrieval.moments import WINDOW_LENGTHS, Moment, Moments, find_moments
    from motionrt.retrieval.ranking import EMBEDDING_ONLY, Weights
    from motionrt.retrieval.records import Caption, Clip, Skipped
    from motionrt.retrieval.search import ExactIndex, Hit, VectorIndex
    from motionrt.retrieval.store import GALLERY_FILE, locate
    from motionrt.retrieval.windows import embed_whole, motion_features, window_spans

_HOMES = {
    "assembly": ("BuildReport", "Progress"),
    "build": ("build_gallery", "update_gallery"),
    "captions": ("EmbeddedCaptions", "checked_captions", "read_captions"),
    "describing": ("Description", "describe"),
    "filters": ("Filter",),
    "finding": ("Hits", "Search", "find", "grouped"),
    "gallery": ("Gallery",),
    "likeness": ("Duplicates", "duplicates", "similar"),
    "moments": ("WINDOW_LENGTHS", "Moment", "Moments", "find_moments"),
    "ranking": ("EMBEDDING_ONLY", "Weights"),
    "records": ("Caption", "Clip", "Skipped"),
    "search": ("ExactIndex", "Hit", "VectorIndex"),
    "store": ("GALLERY_FILE", "locate"),
    "windows": ("embed_whole", "motion_features", "window_spans"),
}

__all__ = [
    "EMBEDDING_ONLY",
    "GALLERY_FILE",
    "WINDOW_LENGTHS",
    "BuildReport",
    "Caption",
    "Clip",
    "Description",
    "Duplicates",
    "EmbeddedCaptions",
    "ExactIndex",
    "Filter",
    "Gallery",
    "Hit",
    "Hits",
    "Moment",
    "Moments",
    "Progress",
    "Search",
    "Skipped",
    "VectorIndex",
    "Weights",
    "build_gallery",
    "checked_captions",
    "describe",
    "duplicates",
    "embed_whole",
    "find",
    "find_moments",
    "grouped",
    "locate",
    "motion_features",
    "read_captions",
    "similar",
    "update_gallery",
    "window_spans",
]

__getattr__ = lazily(__name__, _HOMES)
