"""Libraries in PostgreSQL (pgserver's wheel) and Milvus Lite: rates, disk, and whether they answer as the gallery does.

python benchmarks/engines.py postgres 100000 --graph -o docs/results/engines.json
python benchmarks/engines.py postgres 1000000 --queries 8 -o ...
python benchmarks/engines.py milvus 30000 -o ...

The vectors are those of `scale.py`. The store is closed and opened again before it is asked. Seconds of the processor
are those of this process: the server's own come on top of them.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from scale import QUERIES, STAMP, cpu, disk, gallery_of, median, timed, vectors_of

from motionrt.engines import GalleryStore, PostgresStore, copy_gallery, open_store
from motionrt.retrieval import Filter, Gallery

SHARES = (50, 5, 0.5)
"""Per cent of the windows that filters pass; attributes are even from 0 to 100."""


@contextmanager
def address_of(engine: str, folder: Path) -> Iterator[str]:
    """The address of a library in an engine of its own, whose files are in the folder."""
    if engine == "milvus":
        yield f"milvus://{folder / 'library.db'}#bench"
        return
    with postgres(folder) as sockets:
        yield f"postgresql://postgres@/postgres?host={sockets}#bench"


@contextmanager
def postgres(folder: Path) -> Iterator[Path]:
    """A PostgreSQL of pgserver's programs, a child of this process; gives the folder of its socket."""
    import pgserver

    programs = Path(pgserver.__file__).parent / "pginstall" / "bin"
    user = None
    if os.geteuid() == 0:  # a server refuses to be root
        user = pgserver.utils.ensure_user_exists("pgserver")
        shutil.chown(folder, "pgserver")
    data = folder / "data"
    subprocess.run(
        [programs / "initdb", "-D", data, "-U", "postgres", "-A", "trust"], check=True, stdout=subprocess.DEVNULL,
        user=user and "pgserver", cwd=folder,
    )  # fmt: skip
    command = [programs / "postgres", "-D", data, "-h", "", "-k", folder]
    with (folder / "log").open("wb") as log:
        server = subprocess.Popen(command, stdout=log, stderr=log, user=user and "pgserver", cwd=folder)
        try:
            while not (folder / ".s.PGSQL.5432").exists():
                time.sleep(0.1)
            yield folder
        finally:
            server.send_signal(signal.SIGINT)  # a fast, clean end
            server.wait()


def found(
    store: GalleryStore, query: np.ndarray, told: Filter, *, approximate: bool = False
) -> list[tuple[str, float]]:
    """The ten nearest windows."""
    (one,) = store.nearest(query[None], 10, told, approximate=approximate)
    return list(zip(one.clips, one.spans[:, 0].tolist(), strict=True))


def expected(gallery: Gallery, query: np.ndarray, told: Filter) -> list[tuple[str, float]]:
    """The ten nearest windows of the gallery, by NumPy."""
    scores = np.asarray(gallery.embeddings) @ query
    count = 10
    if told.where is not None:
        share = float(told.where.rpartition("<")[2])
        passes = np.asarray(gallery.attributes)[:, 0] < share
        scores[~passes] = -2
        count = min(10, int(passes.sum()))
    best = np.argsort(-scores, kind="stable")[:count]
    return [(gallery.clips[int(clip)].id, float(start)) for clip, start, _ in gallery.windows[best].tolist()]


def recall(pairs: list[tuple[list[Any], list[Any]]]) -> float:
    """The share of the right ten that were found."""
    return round(float(np.mean([len(set(a) & set(b)) / max(1, len(b)) for a, b in pairs])), 4)


def measured(engine: str, count: int, *, asked: int, graph: bool) -> dict[str, Any]:
    """All figures of one engine and size."""
    from motionrt.motion.attributes import ATTRIBUTES

    gallery = gallery_of(vectors_of(count, noise=False))
    queries = vectors_of(asked, noise=False, seed=99)
    filters = [Filter(), *(Filter(where=f"{ATTRIBUTES[0]} < {share}") for share in SHARES)]
    told: dict[str, Any] = {"engine": engine, "windows": count}
    with tempfile.TemporaryDirectory() as place, address_of(engine, Path(place)) as address:
        store = open_store(address, STAMP)
        _, spent, seconds = cpu(lambda: copy_gallery(gallery, store))
        told |= {"copy_s": seconds, "copy_cpu_s": spent, "windows_per_s": round(count / seconds)}
        print(json.dumps(told), flush=True)
        if graph and isinstance(store, PostgresStore):
            told["graph_s"] = timed(store.index)[1]
        store.close()
        store = open_store(address)
        told["held"] = len(store)
        told["disk_mb"] = round(disk(Path(place)) / 1e6, 1)
        for one in filters:
            name = one.where or "all"
            call = partial(found, store, told=one)
            told[f"exact_ms, {name}"] = median({"": call}, queries)[""]
            told[f"recall_at_10, {name}"] = recall([(call(q), expected(gallery, q, one)) for q in queries])
        if graph:
            near = partial(found, store, told=Filter(), approximate=True)
            told["approximate_ms"] = median({"": near}, queries)[""]
            told["approximate_recall_at_10"] = recall([(near(q), expected(gallery, q, Filter())) for q in queries])
        half = [clip.id for clip in gallery.clips[:1000]]
        told["delete_1000_clips_s"] = timed(lambda: store.delete(half))[1]
        told["held_after"] = len(store)
        store.close()
    return told


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("engine", choices=("postgres", "milvus"))
    parser.add_argument("windows", type=int)
    parser.add_argument("--graph", action="store_true", help="the HNSW graph, too, of PostgreSQL")
    parser.add_argument("--queries", type=int, default=QUERIES)
    parser.add_argument("-o", "--out", type=Path)
    arguments = parser.parse_args()
    told = measured(arguments.engine, arguments.windows, asked=arguments.queries, graph=arguments.graph)
    print(json.dumps(told, indent=1))
    if arguments.out is not None:
        arguments.out.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
