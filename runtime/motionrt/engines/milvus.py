"""A library of motion in Milvus: a cluster, or one process with Milvus Lite."""

from __future__ import annotations

import json
import re
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeVar
from urllib.parse import urlsplit

import numpy as np

from motionrt.engines.conditions import Conditions
from motionrt.engines.packages import package
from motionrt.engines.rows import Row, rows_of
from motionrt.engines.store import KnownFile, Nearest
from motionrt.errors import EngineError, GalleryNotFoundError, InvalidInputError
from motionrt.motion.attributes import ATTRIBUTES
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import Filter, Gallery
from motionrt.retrieval.records import ModelStamp
from motionrt.untrusted.words import shown

T = TypeVar("T")
WIDTH, AT_ONCE = 256, 1000
_OF_MODEL = "_model"  # behind the name of a library: the collection that notes its model
_LONGEST = 60_000  # bytes of an id or a text
_CONDITIONS = Conditions(lambda name: f"a_{name}", "==", "!=", absolute=False)
_FIELDS = ["clip", "start_s", "end_s", "text", "embedding", *(f"a_{name}" for name in ATTRIBUTES)]


class MilvusStore:
    """See :class:`motionrt.engines.GalleryStore`. May be used from several threads, one at a time.

    Args:
        address: ``milvus://[user:password@]host:port``, or ``milvus:///path/to/file.db``.
        library: the collection's name.
        model: makes the library if it is not there, for embeddings of that model.
        patience_s: how long to try again where the server is away, seconds.

    Raises:
        GalleryNotFoundError: no such library, and no model given.
        EngineError: the server cannot be reached, or refuses.
        MissingDependencyError: pymilvus is not installed.
    """

    def __init__(
        self, address: str, library: str, model: ModelStamp | None = None, *, patience_s: float = 30.0
    ) -> None:
        if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,100}", library):
            raise InvalidInputError(f"a library is named by letters, digits and _, not {shown(library)}")
        self._place, self._library, self._patience_s = _place(address), library, patience_s
        self._milvus = package("pymilvus", "Milvus", "milvus")
        self._lock = threading.Lock()
        self._client: Any = None
        self._model = self._run(lambda client: self._prepared(client, model))

    @property
    def model(self) -> ModelStamp:
        """Which model made the embeddings."""
        return self._model

    def __len__(self) -> int:
        def count(client: Any) -> int:
            return int(client.query(self._library, filter="", output_fields=["count(*)"])[0]["count(*)"])

        return self._run(count)

    def known(self, files: Sequence[str]) -> dict[str, KnownFile]:
        """The files of which there are clips."""
        fields = ["file", "clip", "size", "mtime_ns"]

        def ask(client: Any) -> list[tuple[str, str, int, int]]:
            rows: list[dict[str, Any]] = []
            for first in range(0, len(files), AT_ONCE):
                told = f"part == 0 and file in {_quoted(list(files[first : first + AT_ONCE]))}"
                rows += client.query(self._library, told, output_fields=fields, consistency_level="Strong")
            return sorted((row["file"], row["clip"], row["size"], row["mtime_ns"]) for row in rows)

        return KnownFile.grouped(self._run(ask))

    def upsert(self, clips: Gallery) -> None:
        """Add or replace clips."""
        rows = list(rows_of(clips))
        last = {row.clip.id: row.part for row in rows}

        def put(client: Any) -> None:
            for first in range(0, len(rows), AT_ONCE):
                client.upsert(self._library, [_values(row) for row in rows[first : first + AT_ONCE]])
            for part in sorted(set(last.values())):  # windows that a longer clip of that id had
                names = [name for name in last if last[name] == part]
                for first in range(0, len(names), AT_ONCE):
                    told = _quoted(names[first : first + AT_ONCE])
                    client.delete(self._library, filter=f"part > {part} and clip in {told}")
            client.flush(self._library)

        self._run(put)

    def delete(self, ids: Iterable[str]) -> None:
        """Take clips out."""
        gone = list(ids)

        def drop(client: Any) -> None:
            for first in range(0, len(gone), AT_ONCE):
                client.delete(self._library, filter=f"clip in {_quoted(gone[first : first + AT_ONCE])}")
            client.flush(self._library)

        self._run(drop)

    def nearest(
        self,
        queries: FloatArray,
        count: int,
        filter: Filter,  # noqa: A002
        *,
        approximate: bool = False,  # noqa: ARG002 - the index of the collection decides
    ) -> list[Nearest]:
        """The nearest windows of each query, by the collection's index: exact unless somebody made it another one."""
        told = _where(filter)

        def ask(client: Any) -> list[Nearest]:
            found = client.search(
                self._library,
                data=np.asarray(queries, np.float32).tolist(),
                filter=told,
                limit=count,
                output_fields=_FIELDS,
                consistency_level="Strong",
            )
            return [_nearest([hit["entity"] for hit in hits]) for hits in found]

        return self._run(ask)

    def close(self) -> None:
        """Let go of the server."""
        with self._lock:
            self._drop()

    def _prepared(self, client: Any, model: ModelStamp | None) -> ModelStamp:
        if not client.has_collection(self._library):
            if model is None:
                raise GalleryNotFoundError(
                    f"Milvus has no library {self._library}; make it: motionrt gallery copy GALLERY ADDRESS"
                )
            self._make(client, model)
        for name in (self._library, self._library + _OF_MODEL):
            client.load_collection(name)
        told = client.query(self._library + _OF_MODEL, filter="", limit=2, output_fields=["fingerprint", "name"])
        if len(told) != 1:
            raise EngineError(f"the collection {self._library} is none of motionrt")
        return ModelStamp(str(told[0]["name"]), str(told[0]["fingerprint"]))

    def _make(self, client: Any, model: ModelStamp) -> None:
        kinds = self._milvus.DataType
        schema = self._milvus.MilvusClient.create_schema(auto_id=False)
        schema.add_field("key", kinds.VARCHAR, is_primary=True, max_length=65535)
        schema.add_field("clip", kinds.VARCHAR, max_length=65535)
        schema.add_field("text", kinds.VARCHAR, max_length=65535)
        schema.add_field("file", kinds.VARCHAR, max_length=65535)
        for name in ("part", "size", "mtime_ns"):
            schema.add_field(name, kinds.INT64)
        for name in ("start_s", "end_s", "duration_s"):
            schema.add_field(name, kinds.DOUBLE)
        for name in ATTRIBUTES:
            schema.add_field(f"a_{name}", kinds.FLOAT)
        schema.add_field("tags", kinds.ARRAY, element_type=kinds.VARCHAR, max_capacity=100, max_length=1000)
        schema.add_field("embedding", kinds.FLOAT_VECTOR, dim=WIDTH)
        index = self._milvus.MilvusClient.prepare_index_params()
        index.add_index("embedding", index_type="FLAT", metric_type="IP")
        self._note(client, model)  # before what it is about, so that a library always has it
        client.create_collection(self._library, schema=schema, index_params=index)

    def _note(self, client: Any, model: ModelStamp) -> None:
        """Note the model in a collection of its own: Milvus keeps no facts about one, and every one has a vector."""
        kinds, name = self._milvus.DataType, self._library + _OF_MODEL
        if not client.has_collection(name):
            schema = self._milvus.MilvusClient.create_schema(auto_id=False)
            schema.add_field("fingerprint", kinds.VARCHAR, is_primary=True, max_length=200)
            schema.add_field("name", kinds.VARCHAR, max_length=1000)
            schema.add_field("nothing", kinds.FLOAT_VECTOR, dim=2)
            index = self._milvus.MilvusClient.prepare_index_params()
            index.add_index("nothing", index_type="FLAT", metric_type="IP")
            client.create_collection(name, schema=schema, index_params=index)
        client.upsert(name, [{"fingerprint": model.fingerprint, "name": model.name, "nothing": [0.0, 1.0]}])
        client.flush(name)

    def _run(self, work: Callable[[Any], T]) -> T:
        """Do something; again, over a new connection, when the server goes away."""
        until, wait = time.monotonic() + self._patience_s, 0.1
        with self._lock:
            while True:
                try:
                    if self._client is None:
                        self._client = self._milvus.MilvusClient(**self._place, timeout=10)
                    return work(self._client)
                except self._milvus.MilvusException as error:
                    away = isinstance(error, self._milvus.exceptions.MilvusUnavailableException) or error.code in (1, 2)
                    self._drop()
                    if not away or time.monotonic() + wait > until:
                        raise EngineError(f"Milvus: {' '.join(str(error).split())[:300]}") from error
                    time.sleep(wait)
                    wait = min(2 * wait, 2.0)

    def _drop(self) -> None:
        if self._client is not None:
            self._client.close()
            self._client = None


def _place(address: str) -> dict[str, str]:
    """What pymilvus is given for an address."""
    parts = urlsplit(address)
    if not parts.hostname:
        return {"uri": parts.path}
    login = {"token": f"{parts.username}:{parts.password or ''}"} if parts.username else {}
    return {"uri": f"http://{parts.hostname}:{parts.port or 19530}", **login}


def _where(filters: Filter) -> str:
    """The filter in Milvus' words."""
    if filters.text is not None:
        raise InvalidInputError("a store knows nothing of words: filter by tags, folder or attributes")
    parts = []
    if filters.min_s is not None:
        parts.append(f"duration_s >= {filters.min_s!r}")
    if filters.max_s is not None:
        parts.append(f"duration_s <= {filters.max_s!r}")
    if filters.folder is not None:
        name = filters.folder.strip("/")
        below = f"clip >= {_quoted(name + '/')} and clip < {_quoted(name + '0')}"  # 0 comes behind /
        parts.append(f"(({below}) or clip == {_quoted(name)})")
    parts += [f"array_contains(tags, {_quoted(tag.lower())})" for tag in filters.tags]
    if filters.where is not None:
        parts.append(_CONDITIONS.written(filters.where))
    return " and ".join(parts)


def _quoted(value: str | list[str]) -> str:
    return json.dumps(value, ensure_ascii=False)


def _values(row: Row) -> dict[str, Any]:
    clip = row.clip
    if len(clip.id.encode()) > _LONGEST or row.attributes is None:
        raise InvalidInputError(f"the clip {shown(clip.id)} has too long a name, or no attributes: update the gallery")
    return {
        "key": f"{row.part}:{clip.id}", "clip": clip.id, "text": clip.text or "", "part": row.part,
        "file": clip.file, "size": clip.size, "mtime_ns": clip.mtime_ns,
        "start_s": row.start_s, "end_s": row.end_s, "duration_s": clip.duration_s, "tags": list(row.tags[:100]),
        "embedding": row.embedding.tolist(),
        **{f"a_{name}": float(value) for name, value in zip(ATTRIBUTES, row.attributes, strict=True)},
    }  # fmt: skip


def _nearest(rows: list[dict[str, Any]]) -> Nearest:
    return Nearest(
        [row["clip"] for row in rows],
        np.array([[row["start_s"], row["end_s"]] for row in rows], np.float64).reshape(-1, 2),
        np.array([row["embedding"] for row in rows], np.float32).reshape(-1, WIDTH),
        np.array([[row[f"a_{name}"] for name in ATTRIBUTES] for row in rows], np.float32) if rows else None,
        [row["text"] or None for row in rows],
    )
