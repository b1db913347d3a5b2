"""Libraries of motion in databases: PostgreSQL with pgvector, Milvus, or a store of your own."""

from __future__ import annotations

from typing import TYPE_CHECKING

from motionrt._lazy import lazily

if TYPE_CHECKING:
    from motionrt.engines.building import IndexReport, index_into
    from motionrt.engines.copying import copy_gallery
    from motionrt.engines.milvus import MilvusStore
    from motionrt.engines.opening import is_address, open_store
    from motionrt.engines.postgres import PostgresStore
    from motionrt.engines.searching import find_in
    from motionrt.engines.store import GalleryStore, KnownFile, Nearest

_HOMES = {
    "building": ("IndexReport", "index_into"),
    "copying": ("copy_gallery",),
    "milvus": ("MilvusStore",),
    "opening": ("is_address", "open_store"),
    "postgres": ("PostgresStore",),
    "searching": ("find_in",),
    "store": ("GalleryStore", "KnownFile", "Nearest"),
}

__all__ = [
    "GalleryStore",
    "IndexReport",
    "KnownFile",
    "MilvusStore",
    "Nearest",
    "PostgresStore",
    "copy_gallery",
    "find_in",
    "index_into",
    "is_address",
    "open_store",
]

__getattr__ = lazily(__name__, _HOMES)
