"""A library of motion in PostgreSQL with pgvector: many clients, transactions, SQL beside it."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeVar

import numpy as np

from motionrt.engines.conditions import Conditions
from motionrt.engines.packages import package
from motionrt.engines.postgres_copy import COLUMNS, stream
from motionrt.engines.rows import rows_of
from motionrt.engines.store import KnownFile, Nearest
from motionrt.errors import EngineError, GalleryNotFoundError, InvalidInputError
from motionrt.motion.attributes import ATTRIBUTES
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import Filter, Gallery
from motionrt.retrieval.records import ModelStamp
from motionrt.untrusted.words import shown

T = TypeVar("T")
WIDTH = 256
_PLACE = {name: number for number, name in enumerate(ATTRIBUTES, 1)}
_CONDITIONS = Conditions(lambda name: f"attributes[{_PLACE[name]}]")
_MODELS = "create table if not exists motionrt_models (library text primary key, name text, fingerprint text)"
_TABLE = (
    'clip text collate "C", part int, start_s double precision, end_s double precision, duration_s double precision, '
    f"text text, tags text[], embedding vector({WIDTH}), attributes real[], file text, size bigint, mtime_ns bigint, "
    "primary key (clip, part)"
)
_MOST_EF = 1000  # windows that pgvector's graph looks at, at most


class PostgresStore:
    """See :class:`motionrt.engines.GalleryStore`. May be used from several threads, one at a time.

    Where the connection breaks it is made again and the call repeated, which changes nothing, until ``patience_s`` is
    over.

    Args:
        address: of the database, as libpq takes it.
        library: name of the library in it: the table of its windows is called so.
        model: makes the library if it is not there, for embeddings of that model.
        patience_s: how long to try, seconds.

    Raises:
        GalleryNotFoundError: no such library, and no model given.
        EngineError: the database cannot be reached, or has no pgvector.
        MissingDependencyError: psycopg is not installed.
    """

    def __init__(
        self, address: str, library: str, model: ModelStamp | None = None, *, patience_s: float = 30.0
    ) -> None:
        if not re.fullmatch(r"[a-z][a-z0-9_]{0,40}", library):
            raise InvalidInputError(f"a library is named by small letters, digits and _, not {shown(library)}")
        self._address, self._table, self._patience_s = address, library, patience_s
        self._driver = package("psycopg", "PostgreSQL", "postgres")
        self._lock = threading.Lock()
        self._connection: Any = None
        self._model = self._run(lambda cursor: self._prepared(cursor, model))

    @property
    def model(self) -> ModelStamp:
        """Which model made the embeddings."""
        return self._model

    def __len__(self) -> int:
        return int(self._run(lambda cursor: cursor.execute(f"select count(*) from {self._table}").fetchone()[0]))

    def known(self, files: Sequence[str]) -> dict[str, KnownFile]:
        """The files of which there are clips."""
        asked = f"select file, clip, size, mtime_ns from {self._table} where part = 0 and file = any(%s) order by clip"
        return KnownFile.grouped(self._run(lambda cursor: cursor.execute(asked, (list(files),)).fetchall()))

    def upsert(self, clips: Gallery) -> None:
        """Add or replace clips, all of them or none."""
        rows = list(rows_of(clips))

        def put(cursor: Any) -> None:
            cursor.execute(f"create temp table fresh (like {self._table} including defaults) on commit drop")
            with cursor.copy(f"copy fresh ({COLUMNS}) from stdin (format binary)") as copy:
                for piece in stream(rows):
                    copy.write(piece)
            names = COLUMNS.split(", ")
            changes = ", ".join(f"{name} = excluded.{name}" for name in names if name not in ("clip", "part"))
            cursor.execute(  # in one order, so that two clients never wait for each other
                f"insert into {self._table} ({COLUMNS}) select {COLUMNS} from fresh order by clip, part "
                f"on conflict (clip, part) do update set {changes}"
            )
            cursor.execute(
                f"delete from {self._table} old using (select clip, max(part) as last from fresh group by clip) new "
                "where old.clip = new.clip and old.part > new.last"
            )

        self._run(put)

    def delete(self, ids: Iterable[str]) -> None:
        """Take clips out."""
        gone = list(ids)
        self._run(lambda cursor: cursor.execute(f"delete from {self._table} where clip = any(%s)", (gone,)))

    def nearest(
        self,
        queries: FloatArray,
        count: int,
        filter: Filter,  # noqa: A002
        *,
        approximate: bool = False,
    ) -> list[Nearest]:
        """The nearest windows of each query; approximate is by the graph that :meth:`index` makes.

        Where the graph finds fewer than ``count``, as behind a filter that few windows pass, the search is exact.
        """
        where, values = _where(filter)
        select = (
            f"select clip, start_s, end_s, embedding::real[], attributes, text from {self._table} "
            f"where {where} order by embedding <#> %s::vector limit %s"
        )

        def found(cursor: Any, query: FloatArray, *, graph: bool) -> list[tuple[Any, ...]]:
            cursor.execute(f"set local enable_indexscan = {'on' if graph else 'off'}")
            rows: list[tuple[Any, ...]] = cursor.execute(select, (*values, _text(query), count)).fetchall()
            return found(cursor, query, graph=False) if graph and len(rows) < count else rows

        def ask(cursor: Any) -> list[Nearest]:
            cursor.execute(f"set local hnsw.ef_search = {min(max(count, 40), _MOST_EF)}")
            return [_nearest(found(cursor, query, graph=approximate)) for query in queries]

        return self._run(ask)

    def index(self) -> None:
        """Make the graph for approximate search, kept up to date from then on: minutes for 100,000 windows."""
        self._run(
            lambda cursor: cursor.execute(
                f"create index if not exists {self._table}_graph on {self._table} using hnsw (embedding vector_ip_ops)"
            )
        )

    def close(self) -> None:
        """Let go of the connection."""
        with self._lock:
            self._drop()

    def _prepared(self, cursor: Any, model: ModelStamp | None) -> ModelStamp:
        """The model of the library, which is made where there is none."""
        if model is not None:
            cursor.execute("select pg_advisory_xact_lock(7303014)")  # two that make it at once get in each other's way
            cursor.execute("create extension if not exists vector")
            cursor.execute(_MODELS)
            cursor.execute(f"create table if not exists {self._table} ({_TABLE})")
            cursor.execute(f"create index if not exists {self._table}_files on {self._table} (file)")
            cursor.execute(
                "insert into motionrt_models values (%s, %s, %s) on conflict (library) do nothing",
                (self._table, model.name, model.fingerprint),
            )
        there = cursor.execute("select to_regclass('motionrt_models')").fetchone()[0]
        asked = "select name, fingerprint from motionrt_models where library = %s"
        row = cursor.execute(asked, (self._table,)).fetchone() if there else None
        if row is None:
            raise GalleryNotFoundError(
                f"the database has no library {self._table}; make it: motionrt gallery copy GALLERY ADDRESS"
            )
        return ModelStamp(*row)

    def _run(self, work: Callable[[Any], T]) -> T:
        """Do something in a transaction; again, over a new connection, when the server goes away."""
        until = time.monotonic() + self._patience_s
        wait = 0.1
        with self._lock:
            while True:
                try:
                    connection = self._connected()
                    with connection.transaction(), connection.cursor() as cursor:
                        return work(cursor)
                except (self._driver.OperationalError, self._driver.InterfaceError) as error:
                    self._drop()
                    if time.monotonic() + wait > until:
                        raise EngineError(f"the database cannot be reached: {_line(error)}") from error
                    time.sleep(wait)
                    wait = min(2 * wait, 2.0)
                except self._driver.Error as error:
                    raise EngineError(f"the database refuses: {_line(error)}") from error

    def _connected(self) -> Any:
        if self._connection is None or self._connection.closed:
            self._connection = self._driver.connect(
                self._address, autocommit=True, connect_timeout=5, prepare_threshold=None
            )  # a prepared search would keep its plan, whether by the graph or exact, for searches of the other kind
        return self._connection

    def _drop(self) -> None:
        if self._connection is not None:
            self._connection.close()
            self._connection = None


def _where(filters: Filter) -> tuple[str, tuple[Any, ...]]:
    """The filter in SQL, and the values for its places."""
    if filters.text is not None:
        raise InvalidInputError("a store knows nothing of words: filter by tags, folder or attributes")
    parts: list[tuple[str, Any]] = []
    if filters.min_s is not None:
        parts.append(("duration_s >= %s", filters.min_s))
    if filters.max_s is not None:
        parts.append(("duration_s <= %s", filters.max_s))
    if filters.folder is not None:
        parts.append(("starts_with(clip || '/', %s)", filters.folder.strip("/") + "/"))
    if filters.tags:
        parts.append(("tags @> %s::text[]", [tag.lower() for tag in filters.tags]))
    words = [word for word, _ in parts]
    if filters.where is not None:
        words.append(_CONDITIONS.written(filters.where))
    return " and ".join(words) or "true", tuple(value for _, value in parts)


def _text(vector: FloatArray) -> str:
    return "[" + ",".join(map(repr, np.asarray(vector, np.float32).tolist())) + "]"


def _nearest(rows: list[tuple[Any, ...]]) -> Nearest:
    attributes = [row[4] for row in rows]
    whole = bool(rows) and all(row is not None and len(row) == len(ATTRIBUTES) for row in attributes)
    return Nearest(
        [row[0] for row in rows],
        np.array([row[1:3] for row in rows], np.float64).reshape(-1, 2),
        np.array([row[3] for row in rows], np.float32).reshape(-1, WIDTH),
        np.array(attributes, np.float32) if whole else None,
        [row[5] for row in rows],
    )


def _line(error: Exception) -> str:
    return " ".join(str(error).split())[:300]
