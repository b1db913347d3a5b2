"""Files of folders and object stores, indexed into real engines: here, and on a cluster of which a worker is killed."""

from __future__ import annotations

import json
import os
import signal
from collections.abc import Iterator
from pathlib import Path
from uuid import uuid4

import numpy as np
import pytest
from engine_servers import STAMP, Server
from fake_embedder import FakeEmbedder, open_fake
from motions import walking

from motionrt.cli import main
from motionrt.engines import GalleryStore, dask, index_into, open_store
from motionrt.engines.objects import fetched, find_objects
from motionrt.errors import EngineError, GalleryError, InvalidInputError, MotionFileNotFoundError
from motionrt.formats import save_motion
from motionrt.retrieval import Filter, Gallery, build_gallery
from motionrt.services import search

fsspec = pytest.importorskip("fsspec", reason="the extra cluster is not installed")
COUNT = 6
GALLERY = ("hits/gallery.json", "hits/motions-0123456789abcdef.npz")


@pytest.fixture
def library(tmp_path: Path) -> Path:
    return written(tmp_path / "library", COUNT)


def written(folder: Path, count: int) -> Path:
    (folder / "more").mkdir(parents=True)
    for number in range(count):
        name = f"{'more/' if number % 2 else ''}{number:03d}.npz"
        save_motion(walking(20, speed=0.5 + number / count), folder / name)
    return folder


@pytest.fixture
def bucket(library: Path) -> Iterator[str]:
    """The address of the same library in an object store in memory."""
    name = f"/{uuid4().hex}"
    files = fsspec.filesystem("memory")
    files.put(str(library), name, recursive=True)
    yield f"memory:/{name}"
    files.rm(name, recursive=True)


def any_model(*_: object, **__: object) -> FakeEmbedder:
    """In place of the runtime's model; unlike a lambda it can be pickled."""
    return FakeEmbedder()


def contents(store: GalleryStore) -> dict[tuple[str, float], np.ndarray]:
    """Embeddings of all windows, by clip and start."""
    (found,) = store.nearest(np.ones((1, 256), np.float32) / 16, 10_000, Filter())
    return dict(zip(zip(found.clips, found.spans[:, 0].tolist(), strict=True), found.embeddings, strict=True))


def same(store: GalleryStore, gallery: Gallery) -> bool:
    """Whether the store holds the windows of the gallery, and no others."""
    there = contents(store)
    wanted = {
        (gallery.clips[clip].id, start): gallery.embeddings[row]
        for row, (clip, start, _) in enumerate(gallery.windows.tolist())
    }
    return there.keys() == wanted.keys() and all(np.array_equal(there[key], wanted[key]) for key in wanted)


def test_an_object_store_gives_the_clips_that_a_gallery_of_its_files_has(
    library: Path, bucket: str, address: str
) -> None:
    report = index_into(bucket, address, open_fake, batch=2)
    assert (report.files, report.unchanged, report.clips, report.failures) == (COUNT, 0, COUNT, ())
    store = open_store(address)
    assert same(store, build_gallery(library, open_fake).gallery)
    store.close()


def test_done_again_it_reads_what_changed_and_reports_what_cannot_be_read(library: Path, address: str) -> None:
    (library / "broken.bvh").write_text("HIERARCHY no more")
    first = index_into(str(library), address, open_fake)
    assert [failure.path for failure in first.failures] == ["broken.bvh"]
    save_motion(walking(400), library / "000.npz")
    save_motion(walking(33), library / "new.npz")
    again = index_into(str(library), address, open_fake, batch=1)
    assert (again.files, again.unchanged, again.clips) == (COUNT + 2, COUNT - 1, 2)
    assert [failure.path for failure in again.failures] == ["broken.bvh"]
    save_motion(walking(25), library / "000.npz")  # fewer windows than before
    index_into(str(library), address, open_fake)
    store = open_store(address)
    assert same(store, build_gallery(library, open_fake).gallery)
    store.close()


def test_a_store_knows_the_files_of_its_clips(library: Path, store: GalleryStore) -> None:
    gallery = build_gallery(library, open_fake).gallery
    store.upsert(gallery)
    known = store.known(["000.npz", "more/001.npz", "none.npz"])
    assert known.keys() == {"000.npz", "more/001.npz"}
    stat = (library / "000.npz").stat()
    assert (known["000.npz"].size, known["000.npz"].mtime_ns) == (stat.st_size, stat.st_mtime_ns)
    assert known["000.npz"].clips == ("000.npz",)


def test_another_models_library_is_refused(library: Path, address: str) -> None:
    open_store(address, STAMP).close()
    with pytest.raises(GalleryError, match="embedded by"):
        index_into(str(library), address, lambda: FakeEmbedder("0" * 64, "another"))


def test_the_command_line_indexes_into_a_database(
    bucket: str, library: Path, address: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(search, "TextMotionModel", any_model)
    (library / "broken.bvh").write_text("HIERARCHY no more")
    assert main(["gallery", "build", bucket, "-o", address]) == 0
    assert f"{COUNT} clips, {COUNT} windows indexed" in capsys.readouterr().out
    assert main(["gallery", "build", str(library), "-o", address, "--json"]) == 3
    told = json.loads(capsys.readouterr().out)
    assert (told["files"], told["clips"], told["skipped"][0]["path"]) == (COUNT + 1, COUNT, "broken.bvh")
    assert main(["gallery", "build", bucket]) == 1
    assert "need a database" in capsys.readouterr().err


def test_what_lies_beside_a_file_is_fetched_with_it(tmp_path: Path) -> None:
    files = fsspec.filesystem("memory")
    root = f"/{uuid4().hex}"
    for name in ("a/x.amc", "a/one.asf", "a/other.bvh", "b/y.gltf", "b/y.bin", "all.asf", ".hidden/z.bvh", *GALLERY):
        files.pipe(f"{root}/{name}", name.encode())
    assert set(find_objects(f"memory:/{root}")) == {"a/x.amc", "a/other.bvh", "b/y.gltf"}
    with fetched(f"memory:/{root}", ["a/x.amc", "b/y.gltf"], "all.asf") as folder:
        there = {path.relative_to(folder).as_posix(): path.read_text() for path in folder.rglob("*") if path.is_file()}
    assert there == {name: name for name in ("a/x.amc", "a/one.asf", "b/y.gltf", "b/y.bin", "all.asf")}
    assert not folder.exists()


def test_places_that_are_none_are_told(tmp_path: Path, postgres: Server) -> None:
    with pytest.raises(MotionFileNotFoundError):
        find_objects(str(tmp_path / "none"))
    with pytest.raises(InvalidInputError, match="no motion files"):
        find_objects(str(tmp_path))
    with pytest.raises(InvalidInputError, match="fsspec"):
        find_objects("nothing://bucket")


@pytest.fixture
def cluster() -> Iterator[object]:
    distributed = pytest.importorskip("distributed", reason="the extra cluster is not installed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address=None, silence_logs=50
    ) as made:
        yield made


def test_a_worker_that_is_killed_half_way_loses_nothing(tmp_path: Path, cluster: object, postgres: Server) -> None:
    import distributed

    library = written(tmp_path / "library", 40)
    (library / "broken.bvh").write_text("HIERARCHY no more")
    address, place = f"{postgres.address}#farm", cluster.scheduler_address  # type: ignore[attr-defined]
    with distributed.Client(place, set_as_default=False) as client:
        workers = list(client.run(os.getpid).values())
    killed = []

    def progress(done: int, total: int, _: str) -> None:
        if done >= total // 2 and not killed:
            killed.append(workers[0])
            os.kill(workers[0], signal.SIGKILL)

    report = index_into(str(library), address, open_fake, on=place, batch=2, progress=progress)
    assert killed
    assert (report.files, report.clips) == (41, 40)
    assert [failure.path for failure in report.failures] == ["broken.bvh"]
    store = open_store(address)
    assert same(store, build_gallery(library, open_fake).gallery)
    store.close()
    again = index_into(str(library), address, open_fake, on=place.replace("tcp", "dask"))
    assert (again.unchanged, again.clips) == (40, 0)


def test_a_scheduler_that_is_away_and_one_of_another_kind_are_told(
    library: Path, postgres: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed", reason="the extra cluster is not installed")
    monkeypatch.setattr(dask, "_PATIENCE_S", 1)
    address = f"{postgres.address}#away"
    with pytest.raises(InvalidInputError, match="dask://host"):
        index_into(str(library), address, open_fake, on="ray://127.0.0.1:9")
    with pytest.raises(EngineError, match="no Dask scheduler answers"):
        index_into(str(library), address, open_fake, on="dask://127.0.0.1:9")
