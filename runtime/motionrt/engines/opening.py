"""Stores by their address: ``postgresql://...#library`` and ``milvus://...#library``."""

from __future__ import annotations

from urllib.parse import urlsplit

from motionrt.engines.store import GalleryStore
from motionrt.errors import InvalidInputError
from motionrt.retrieval.records import ModelStamp
from motionrt.untrusted.words import shown

SCHEMES = ("postgresql", "postgres", "milvus")
LIBRARY = "motionrt"


def is_address(gallery: object) -> bool:
    """Whether this is the address of a store, and no folder."""
    return isinstance(gallery, str) and gallery.partition("://")[0] in SCHEMES and "://" in gallery


def open_store(address: str, model: ModelStamp | None = None) -> GalleryStore:
    """Open the library of a database.

    Args:
        address: ``postgresql://user@host/database#library``, as libpq takes it; ``milvus://host:19530#library``, or
            ``milvus:///path/to/file.db#library`` for the one process of Milvus Lite. The library is ``motionrt`` where
            none is named.
        model: makes a library that is not there yet, for embeddings of that model.

    Raises:
        InvalidInputError: no such kind of address.
        GalleryNotFoundError: no such library, and no model given.
        EngineError: the database cannot be reached.
        MissingDependencyError: its package is not installed.
    """
    if not is_address(address):
        raise InvalidInputError(f"{shown(address)} is no address of a store: they begin with {', '.join(SCHEMES)}://")
    place, _, library = address.partition("#")
    if urlsplit(place).scheme == "milvus":
        from motionrt.engines.milvus import MilvusStore

        return MilvusStore(place, library or LIBRARY, model)
    from motionrt.engines.postgres import PostgresStore

    return PostgresStore(place, library or LIBRARY, model)
