"""Galleries of 10,000 to 5,000,000 windows beside faiss, usearch and NumPy; and a library of 20,000 files that changes.

python benchmarks/scale.py windows 10000 100000 1000000 -o docs/results/scale.json
python benchmarks/scale.py windows 1000000 --keep /tmp/scale --parts graphs --precision  # builds, which may take hours
python benchmarks/scale.py windows 1000000 --keep /tmp/scale --parts queries rivals --precision  # on a quiet machine
python benchmarks/scale.py windows 5000000 --parts queries --precision -o ...
python benchmarks/scale.py library 20000 -o ...
python benchmarks/scale.py kills 20000 -o ...

Vectors are unit vectors around many centres whose spread lies in few directions, as embeddings of motion have it
(--noise: evenly everywhere, the worst case). All contenders answer in turn, so that a busy machine slows all alike;
figures are medians. Run it by `OMP_NUM_THREADS=1` for one thread each.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

from motionrt.motion.attributes import ATTRIBUTES
from motionrt.retrieval import EMBEDDING_ONLY, Filter, Gallery, Search, build_gallery, find, update_gallery
from motionrt.retrieval.clip_table import ClipTable
from motionrt.retrieval.records import WINDOW_TYPE, ModelStamp
from motionrt.retrieval.strings import Strings

WIDTH, QUERIES = 256, 40
PARTS = ("graphs", "queries", "rivals", "growth")
STAMP = ModelStamp("benchmark", "b" * 64)


def vectors_of(count: int, *, noise: bool, seed: int = 0) -> np.ndarray:
    """``(count, 256)`` unit vectors."""
    draw = np.random.default_rng(seed)
    spread = np.ones(WIDTH, np.float32) if noise else (0.93 ** np.arange(WIDTH)).astype(np.float32)
    centres = np.random.default_rng(7).standard_normal((2000, WIDTH), np.float32) * spread
    vectors = np.empty((count, WIDTH), np.float32)
    for start in range(0, count, 65536):
        part = vectors[start : start + 65536]
        draw.standard_normal(out=part, dtype=np.float32)
        part *= spread
        if not noise:
            part *= 0.7
            part += centres[draw.integers(0, len(centres), len(part))]
        part /= np.linalg.norm(part, axis=1, keepdims=True)
    return vectors


def gallery_of(vectors: np.ndarray, prefix: str = "") -> Gallery:
    """A gallery of clips of two windows, in 100 folders, with attributes."""
    clips = len(vectors) // 2
    per_folder = max(1, clips // 100)
    ids = Strings.of(f"{prefix}{n // per_folder:04d}/{n:08d}.bvh" for n in range(clips))
    facts = {
        "duration_s": np.full(clips, 15.0),
        "size": np.zeros(clips, np.int64),
        "mtime_ns": np.zeros(clips, np.int64),
        "sha256": np.zeros((clips, 32), np.uint8),
        "has_text": np.zeros(clips, np.uint8),
        "animation": np.full(clips, -1, np.int32),
    }
    table = ClipTable(ids, Strings(np.zeros(0, np.uint8), np.zeros(clips, np.int64)), facts, ordered=True)
    windows = np.zeros(2 * clips, WINDOW_TYPE)
    windows["clip"] = np.arange(2 * clips) // 2
    windows["start_s"], windows["end_s"] = np.tile([0, 5], clips), np.tile([10, 15], clips)
    attributes = np.random.default_rng(1).uniform(0, 100, (2 * clips, len(ATTRIBUTES))).astype(np.float32)
    return Gallery(table, vectors, windows, STAMP, attributes=attributes)


def median(calls: dict[str, Callable[[np.ndarray], Any]], queries: np.ndarray) -> dict[str, float]:
    """Milliseconds of each call, all in turn for every query."""
    times: dict[str, list[float]] = {name: [] for name in calls}
    for query in queries:
        for name, call in calls.items():
            began = time.perf_counter()
            call(query)
            times[name].append(1000 * (time.perf_counter() - began))
    return {name: round(float(np.median(of[len(of) // 4 :])), 3) for name, of in times.items()}


def timed(call: Callable[[], Any]) -> tuple[Any, float]:
    """What a call gives, and its seconds."""
    began = time.perf_counter()
    result = call()
    return result, round(time.perf_counter() - began, 3)


def disk(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def memory() -> int:
    """Resident MB of this process at most so far."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024


def windows(count: int, place: Path, parts: Sequence[str], *, noise: bool, precisions: Sequence[str]) -> dict[str, Any]:
    """All figures of one size; what was built for it stays in the folder, and is not built again."""
    folder = place / "gallery"
    told: dict[str, Any] = {"windows": count, "noise": noise}
    if not folder.is_dir():
        made = gallery_of(vectors_of(count, noise=noise))
        _, told["save_cpu_s"], told["save_s"] = cpu(lambda: made.save(folder))
        del made
    told["disk_mb"] = round(sum(path.stat().st_size for path in folder.iterdir() if path.suffix != ".faiss") / 1e6, 1)
    opens = [timed(lambda: Gallery.open(folder))[1] for _ in range(9)]
    told["open_ms"] = round(1000 * float(np.median(opens)), 1)
    gallery = Gallery.open(folder)
    queries = vectors_of(QUERIES, noise=noise, seed=99)
    if "graphs" in parts:
        told |= graphs_of(gallery, place)
    if "queries" in parts:
        told["prepare_s"] = timed(gallery.prepare)[1]
        told["memory_mb"] = memory()
        told |= queries_of(gallery, queries)
        if "rivals" in parts:
            told |= contest(gallery, queries, place)
    if "growth" in parts:
        with copied(folder) as own:
            told |= growth_of(Gallery.open(own), count, noise=noise)
    if precisions:
        with copied(folder) as own:
            told["precision"] = {precision: packed(folder, own, precision, queries) for precision in precisions}
    return told


@contextmanager
def copied(folder: Path) -> Iterator[Path]:
    """A gallery's files in a folder of their own, to be changed."""
    with tempfile.TemporaryDirectory(dir=folder.parent) as place:
        yield Path(shutil.copytree(folder, Path(place) / "gallery", ignore=shutil.ignore_patterns("*.faiss")))


def queries_of(gallery: Gallery, queries: np.ndarray) -> dict[str, Any]:
    """Milliseconds of a question to the gallery alone, by embedding, by text, and behind filters."""
    told: dict[str, Any] = {"exact_ms": median({"motionrt": lambda q: gallery.nearest(q, 10)}, queries)["motionrt"]}
    calls = {"by text": lambda q: find(gallery, "turns left", q, Search(anyway=True))}
    for share in (50, 5, 0.5):
        search = Search(weights=EMBEDDING_ONLY, filter=Filter(where=f"turn < {share}"), anyway=True)
        calls[f"where {share} %"] = lambda q, s=search: find(gallery, "walk", q, s)
    folders = Search(weights=EMBEDDING_ONLY, filter=Filter(folder="0007"), anyway=True)
    calls["folder 1 %"] = lambda q: find(gallery, "walk", q, folders)
    told["search_ms"] = {name: median({name: call}, queries)[name] for name, call in calls.items()}
    return told


def contest(gallery: Gallery, queries: np.ndarray, place: Path) -> dict[str, Any]:
    """Milliseconds of motionrt and its rivals in turn, and what approximate ones find."""
    vectors = np.array(gallery.embeddings)
    exact: dict[str, Callable[[np.ndarray], Any]] = {
        "motionrt": lambda q: gallery.nearest(q, 10),
        "numpy": lambda q: np.argpartition(vectors @ q, -10)[-10:],
    }
    with suppress(ImportError):
        import faiss

        flat = faiss.IndexFlatIP(WIDTH)
        flat.add(vectors)
        exact["faiss flat"] = lambda q: flat.search(q[None], 10)[1][0]
    told: dict[str, Any] = {"exact_in_turn_ms": median(exact, queries[:16])}
    best = [set(gallery.nearest(q, 10).tolist()) for q in queries]
    approximate: dict[str, Callable[[np.ndarray], Any]] = {}
    if any((place / "gallery").glob("*.faiss")):
        gallery.prepare(approximate=True)
        approximate["motionrt"] = lambda q: gallery.nearest(q, 10, approximate=True)
    approximate |= rivals(vectors, place, build=False)[0]
    told["approximate_ms"] = median(approximate, queries)
    told["recall_at_10"] = {
        name: round(float(np.mean([len(_set(call(q)) & b) / 10 for q, b in zip(queries, best, strict=True)])), 4)
        for name, call in approximate.items()
    }
    return told


def _set(found: Any) -> set[int]:
    return set(np.asarray(found).tolist())


def graphs_of(gallery: Gallery, place: Path) -> dict[str, Any]:
    """Processor's seconds of all graphs, built and kept."""
    told = {"motionrt": cpu(lambda: gallery.prepare(approximate=True))[1]}
    return {"graph_cpu_s": told | rivals(np.array(gallery.embeddings), place, build=True)[1]}


def rivals(
    vectors: np.ndarray, place: Path, *, build: bool
) -> tuple[dict[str, Callable[[np.ndarray], Any]], dict[str, float]]:
    """The graphs of faiss and usearch, as they are used plainly; those that were kept, or all."""
    calls: dict[str, Callable[[np.ndarray], Any]] = {}
    spent: dict[str, float] = {}
    with suppress(ImportError):
        import faiss

        file = place / "hnsw.faiss"
        if file.is_file() or build:

            def made() -> Any:
                if file.is_file():
                    return faiss.read_index(str(file))
                graph = faiss.index_factory(WIDTH, "HNSW32,SQ8", faiss.METRIC_INNER_PRODUCT)
                graph.train(vectors[:50_000])
                graph.add(vectors)
                faiss.write_index(graph, str(file))
                return graph

            graph, spent["faiss HNSW32,SQ8"], _ = cpu(made)
            graph.hnsw.efSearch = 64
            calls["faiss HNSW32,SQ8"] = lambda q: graph.search(q[None], 10)[1][0]
    with suppress(ImportError):
        from usearch.index import Index

        kept = place / "graph.usearch"
        if kept.is_file() or build:
            index = Index(ndim=WIDTH, metric="ip", dtype="f16")

            def filled() -> None:
                if kept.is_file():
                    index.load(str(kept))
                    return
                index.add(np.arange(len(vectors)), vectors)
                index.save(str(kept))

            spent["usearch f16"] = cpu(filled)[1]
            calls["usearch f16"] = lambda q: index.search(q, 10).keys
    return calls, spent


def growth_of(gallery: Gallery, count: int, *, noise: bool) -> dict[str, Any]:
    """An update of one per cent: half of it new, half of it deleted."""
    folder = gallery.folder
    assert folder is not None
    before = {path.name for path in folder.iterdir()}
    more = gallery_of(vectors_of(max(2, count // 200 // 2 * 2), noise=noise, seed=5), "new")
    gone = [
        gallery.clips[n].id for n in range(0, len(gallery.clips), max(1, len(gallery.clips) // (count // 400 or 1)))
    ]
    grown, append_s = timed(lambda: gallery.append(more))
    grown, delete_s = timed(lambda: grown.delete(gone))
    new = [path for path in folder.iterdir() if path.name not in before]
    told: dict[str, Any] = {
        "append_s": append_s,
        "delete_s": delete_s,
        "written_mb": round(sum(path.stat().st_size for path in new) / 1e6, 2),
        "segments": len(grown.segments),
    }
    grown.prepare()
    queries = vectors_of(QUERIES, noise=noise, seed=99)
    told["exact_ms_after"] = median({"motionrt": lambda q: grown.nearest(q, 10)}, queries)["motionrt"]
    told["compact_s"] = timed(grown.compact)[1]
    return told


def packed(folder: Path, own: Path, precision: str, queries: np.ndarray) -> dict[str, Any]:
    """Disk, time and recall of fewer bits, written to ``own``, against the gallery in ``folder``."""
    plain = Gallery.open(folder).prepare()
    exact = [plain.nearest(q, 10).tolist() for q in queries]
    shutil.rmtree(own)
    small = Gallery.open(Path(shutil.copytree(folder, own, ignore=shutil.ignore_patterns("*.faiss"))))
    small = small.compact(precision).prepare()
    found = [small.nearest(q, 10).tolist() for q in queries]
    (file,) = own.glob("embeddings-*")
    return {
        "bytes_a_window": round(file.stat().st_size / len(small.windows), 1),
        "exact_ms": median({"motionrt": lambda q: small.nearest(q, 10)}, queries)["motionrt"],
        "recall_at_10": round(
            float(np.mean([len(set(a) & set(b)) / 10 for a, b in zip(found, exact, strict=True)])), 4
        ),
        "same_top_10": round(float(np.mean([set(a) == set(b) for a, b in zip(found, exact, strict=True)])), 3),
    }


class Instant:
    """A stand-in for the motion encoder, so that what is measured is all the rest."""

    name, fingerprint = "instant", "1" * 64

    def embed_motion(self, features: Sequence[np.ndarray]) -> np.ndarray:
        """A vector of each window's first and last frames."""
        rows = np.stack([window[0, :WIDTH] + window[-1, :WIDTH] for window in features]) + np.float32(1e-3)
        return (rows / np.linalg.norm(rows, axis=1, keepdims=True)).astype(np.float32)


def open_instant() -> Instant:
    return Instant()


def write_library(folder: Path, count: int) -> None:
    """So many short motions in 100 folders."""
    import motionrt
    from motionrt.motion import Motion

    draw = np.random.default_rng(0)
    plain = motionrt.Runtime().gallery().motion(motionrt.Runtime().gallery().clips[0].id)[:12]
    for number in range(count):
        place = folder / f"{number % 100:02d}"
        place.mkdir(exist_ok=True, parents=True)
        root = plain.root + draw.normal(0, 0.01, plain.root.shape).astype(np.float32)
        Motion(plain.rotations, root, plain.fps).save(place / f"clip{number:06d}.npz")


def cpu(call: Callable[[], Any]) -> tuple[Any, float, float]:
    began, clock = time.process_time(), time.perf_counter()
    result = call()
    return result, round(time.process_time() - began, 2), round(time.perf_counter() - clock, 2)


def library(count: int, jobs: int) -> dict[str, Any]:
    """Build, update without changes, and with 100 files changed and 100 deleted."""
    with tempfile.TemporaryDirectory(dir=os.environ.get("MOTIONRT_SCRATCH")) as place:
        folder = Path(place) / "library"
        write_library(folder, count)
        report, seconds = timed(lambda: build_gallery(folder, open_instant, jobs=jobs))
        rate = {"build_s": seconds, "index_clips_per_s_without_model": round(report.clips_per_s, 1)}
        return {"files": count, "jobs": jobs, **rate, **updates_of(folder)}


def updates_of(folder: Path) -> dict[str, Any]:
    """Updates of an indexed folder: processor's and clock's seconds, and bytes."""
    told: dict[str, Any] = {}
    _, told["unchanged_cpu_s"], told["unchanged_s"] = cpu(lambda: update_gallery(folder, open_instant))
    files = sorted(folder.rglob("*.npz"))
    picked = random.Random(0).sample(files, 200)
    for number, path in enumerate(picked[:100]):
        shutil.copy(files[number], path)
    for path in picked[100:]:
        path.unlink()
    gallery = folder / ".motionrt-gallery"
    before = {path.name for path in gallery.iterdir()}
    report, told["changed_cpu_s"], told["changed_s"] = cpu(lambda: update_gallery(folder, open_instant))
    told["changed"] = [len(report.added), len(report.changed), len(report.removed), report.indexed]
    written = [path for path in gallery.iterdir() if path.name not in before or path.name == "gallery.json"]
    told["written_mb"] = round(sum(path.stat().st_size for path in written) / 1e6, 2)
    told["gallery_mb"] = round(disk(gallery) / 1e6, 2)
    return told


KILLED = """
import sys
sys.path[:0] = [{here!r}, *{paths!r}]
from scale import open_instant
from motionrt.retrieval import build_gallery, journal
journal.EVERY_S = 1.0
build_gallery({folder!r}, open_instant, out={out!r}, progress=lambda *_: print(flush=True))
"""


def killed(count: int, kills: int) -> dict[str, Any]:
    """A build in a process that is killed again and again: how much is read in all, and whether anything is lost.

    Each time it dies after a random number of files, so that the deaths lie all over the library, and within a random
    fiftieth of a second, which is anywhere in the work on a file or in what is kept of it.
    """
    with tempfile.TemporaryDirectory(dir=os.environ.get("MOTIONRT_SCRATCH")) as place:
        folder, out = Path(place) / "library", Path(place) / "killed"
        write_library(folder, count)
        code = KILLED.format(here=str(Path(__file__).parent), paths=sys.path, folder=str(folder), out=str(out))
        draw, died, read = random.Random(1), 0, 0
        for _ in range(kills):
            child = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
            assert child.stdout is not None
            for _ in range(draw.randrange(1, 2 * count // (kills + 1))):
                read += len(child.stdout.readline())
            time.sleep(draw.uniform(0, 0.02))
            died += child.poll() is None
            child.kill()
            child.communicate()
        report = build_gallery(folder, open_instant, out=out)
        report.gallery.verify()
        files = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*.npz"))
        lost = [clip.id for clip in report.gallery.clips] != files
    left = report.indexed
    return {"files": count, "kills": died, "read_until_the_last": read, "left_to_index": left, "lost": lost}


@contextmanager
def scratch(keep: Path | None, name: str) -> Iterator[Path]:
    """A folder that stays, or goes afterwards."""
    if keep is not None:
        (keep / name).mkdir(parents=True, exist_ok=True)
        yield keep / name
        return
    with tempfile.TemporaryDirectory(dir=os.environ.get("MOTIONRT_SCRATCH")) as place:
        yield Path(place)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("what", choices=("windows", "library", "kills"))
    parser.add_argument("sizes", type=int, nargs="+")
    parser.add_argument("--noise", action="store_true", help="evenly spread vectors, the worst case")
    parser.add_argument("--parts", nargs="*", choices=PARTS, default=PARTS, help="what is measured; graphs take long")
    parser.add_argument("--precision", nargs="*", default=["float16", "int8"])
    parser.add_argument("--keep", type=Path, help="a folder for galleries and graphs that are used again")
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--jobs", type=int, default=1, help="processes of the library's build")
    parser.add_argument("-o", "--out", type=Path)
    arguments = parser.parse_args()
    told = []
    for size in arguments.sizes:
        if arguments.what == "library":
            told.append(library(size, arguments.jobs))
        elif arguments.what == "kills":
            told.append(killed(size, arguments.kills))
        else:
            with scratch(arguments.keep, f"{size}{'-noise' if arguments.noise else ''}") as place:
                told.append(
                    windows(size, place, arguments.parts, noise=arguments.noise, precisions=arguments.precision)
                )
        print(json.dumps(told[-1], indent=1), flush=True)
    if arguments.out is not None:
        arguments.out.write_text(json.dumps(told, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
