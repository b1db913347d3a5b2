"""``motionrt gallery``: build, update and look at galleries."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionrt.cli.console import Progress, print_json, working
from motionrt.cli.options import add_json, add_models, add_output, command, runtime
from motionrt.cli.reading import INPUTS, add_reading, in_options, reading
from motionrt.cli.skipped import SOME_SKIPPED, by_reason, say_skipped
from motionrt.errors import InvalidInputError

if TYPE_CHECKING:
    from motionrt.retrieval import BuildReport, Gallery

PRECISIONS = ("float32", "float16", "int8")
BUILD = f"""index a folder of motion files, with all folders below it
Reads {INPUTS}; each animation of a file that
holds several is a clip of its own. How the files are read (--source-fps, --up, ...) is kept for updates.
Files that cannot be read are listed with the reason, and the exit code is then 3.
With -o DATABASE (as in gallery copy) the clips go there; FOLDER may be an object store then (s3://bucket/library), and
--on has the machines of a Dask cluster do the work. Broken off or given again, the command does what is left to do."""
UPDATE = """bring a gallery up to date with its folder
Only new and changed files are read, and files that are gone are dropped."""
VERIFY = """read a gallery in full and check every file of it against its checksum
The exit code is 1 where something is damaged; the message names it."""
COMPACT = """write a gallery as one segment, without what was deleted, in the layout of today
With --precision its embeddings are stored in other bits from then on."""
COPY = """put a gallery into a database, whose clips of the same ids it replaces
The address is like postgresql://user@host/database#library or milvus://host:19530#library (extras postgres, milvus);
broken off, the command may simply be given again. Search it by: motionrt retrieve TEXT --gallery ADDRESS"""
DUPLICATES = """list the clips of a gallery that show the same motion: equal files, or as long and alike
Mirror images are not the same."""
SHEET = """write a contact sheet: every clip as a strip of poses, in one HTML file
It opens in any browser and needs nothing else."""
INFO = """show what a gallery holds, and check its files for damage"""


NO_ATTRIBUTES = "none yet: motionrt gallery update"


def add(commands: Any) -> None:
    """Add the command and its three parts."""
    group = commands.add_parser("gallery", help="build, update and look at galleries")
    parts = group.add_subparsers(title="commands", metavar="COMMAND", required=True)
    build = command(parts, "build", run_build, BUILD)
    build.add_argument("folder", type=_place, help="where the motion files are")
    build.add_argument(
        *("-o", "--output", "--out"),
        dest="out",
        type=_place,
        metavar="DIR",
        help="gallery (default: FOLDER/.motionrt-gallery), or the address of a database",
    )
    build.add_argument("--on", metavar="ADDRESS", help="a Dask scheduler, dask://host:8786 (extra cluster); no Ray")
    add_reading(build)
    update = command(parts, "update", run_update, UPDATE)
    update.add_argument("gallery", type=Path, help="a gallery, or the folder that was indexed")
    build.add_argument("--precision", choices=PRECISIONS, default="float32", help="of stored embeddings")
    for parser in (build, update):
        parser.add_argument("--jobs", type=int, metavar="N", help="processes, of one thread each (default: all cores)")
    compact = command(parts, "compact", run_compact, COMPACT)
    compact.add_argument("gallery", type=Path, help="a gallery, or the folder that was indexed")
    compact.add_argument("--precision", choices=PRECISIONS, help="of stored embeddings (default: as it is)")
    verify = command(parts, "verify", run_verify, VERIFY)
    verify.add_argument("gallery", type=Path, help="a gallery, or the folder that was indexed")
    sheet = command(parts, "sheet", run_sheet, SHEET)
    sheet.add_argument("gallery", type=Path, nargs="?", help="a gallery, or the folder that was indexed")
    add_output(sheet, "file to write (.html)", ())
    info = command(parts, "info", run_info, INFO)
    info.add_argument("gallery", type=Path, help="a gallery, or the folder that was indexed")
    for parser in (build, update):
        add_models(parser, threads=False)
    same = command(parts, "duplicates", run_duplicates, DUPLICATES)
    same.add_argument("gallery", type=Path, help="a gallery, or the folder that was indexed")
    same.add_argument("--cosine", type=float, default=0.985, metavar="C", help="how alike, at most 1 (default: 0.985)")
    copy = command(parts, "copy", run_copy, COPY)
    copy.add_argument("gallery", type=Path, help="a gallery, or the folder that was indexed")
    copy.add_argument("address", help="of the library in the database")
    for parser in (build, update, compact, copy, verify, info, same):
        add_json(parser)


def run_build(arguments: argparse.Namespace) -> int:
    """``gallery build``."""
    if isinstance(arguments.out, str):
        return _index(arguments)
    if isinstance(arguments.folder, str) or arguments.on is not None:
        raise InvalidInputError(
            "--on and object stores need a database for the clips: -o postgresql://... or milvus://..."
        )
    started = time.perf_counter()
    report = runtime(arguments).build_gallery(
        arguments.folder,
        arguments.out,
        jobs=_jobs(arguments),
        progress=Progress(),
        precision=arguments.precision,
        **reading(arguments),
    )
    return _finish(report, arguments, time.perf_counter() - started)


def run_update(arguments: argparse.Namespace) -> int:
    """``gallery update``."""
    started = time.perf_counter()
    report = runtime(arguments).update_gallery(arguments.gallery, jobs=_jobs(arguments), progress=Progress())
    return _finish(report, arguments, time.perf_counter() - started)


def run_info(arguments: argparse.Namespace) -> int:
    """``gallery info``."""
    from motionrt.retrieval import Gallery

    gallery = Gallery.open(arguments.gallery)
    gallery.verify()
    facts = describe(gallery)
    if arguments.json:
        print_json(facts)
        return 0
    model = gallery.model
    print(f"gallery  {facts['gallery']}")
    print(f"source   {facts['source'] or 'none (motions are stored in the gallery)'}")
    print(f"clips    {facts['clips']}, {facts['hours']:.2f} h, {facts['windows']} windows of 10 s")
    print(f"model    {model.name} ({model.fingerprint[:12]})")
    print(f"words    {facts['captions']} captions; attributes: {'yes' if facts['attributes'] else NO_ATTRIBUTES}")
    print(f"stored   {facts['precision']}, {facts['segments']} {'segment' if facts['segments'] == 1 else 'segments'}")
    print(f"skipped  {len(gallery.skipped)}")
    for count, name, reason in by_reason([(skipped.path, skipped.reason) for skipped in gallery.skipped]):
        print(f"  {name}{f' and {count - 1} more' if count > 1 else ''}: {reason}")
    return 0


def run_compact(arguments: argparse.Namespace) -> int:
    """``gallery compact``."""
    from motionrt.retrieval import Gallery

    gallery = Gallery.open(arguments.gallery).compact(arguments.precision)
    if arguments.json:
        print_json(describe(gallery))
    else:
        print(f"{gallery.folder}: one segment of {len(gallery)} clips, {len(gallery.windows)} windows")
    return 0


def run_copy(arguments: argparse.Namespace) -> int:
    """``gallery copy``."""
    from motionrt.engines import copy_gallery, open_store
    from motionrt.retrieval import Gallery

    gallery, progress = Gallery.open(arguments.gallery), Progress()
    store = open_store(arguments.address, gallery.model)
    copied = copy_gallery(gallery, store, lambda done, total: progress(done, total, "clips"))
    if arguments.json:
        print_json({"clips": copied, "windows": len(store)})
    else:
        print(f"{copied} clips copied; the library holds {len(store)} windows")
    store.close()
    return 0


def run_verify(arguments: argparse.Namespace) -> int:
    """``gallery verify``."""
    from motionrt.retrieval import Gallery

    gallery = Gallery.open(arguments.gallery)
    with working("checking"):
        gallery.verify()
    if arguments.json:
        print_json({**describe(gallery), "whole": True})
    else:
        print(f"{gallery.folder}: whole ({len(gallery)} clips, {len(gallery.windows)} windows)")
    return 0


def run_sheet(arguments: argparse.Namespace) -> int:
    """``gallery sheet``."""
    from motionrt.retrieval.sheet import save_sheet
    from motionrt.runtime import Runtime

    gallery = Runtime().gallery(arguments.gallery)
    path = save_sheet(gallery, arguments.output, Progress())
    print(f"{path}: {len(gallery)} clips, {max(1, round(path.stat().st_size / 1000))} kB")
    return 0


def run_duplicates(arguments: argparse.Namespace) -> int:
    """``gallery duplicates``."""
    from motionrt.retrieval import Gallery, duplicates

    with working("comparing"):
        groups = duplicates(Gallery.open(arguments.gallery), arguments.cosine)
    if arguments.json:
        print_json([{"ids": list(g.ids), "identical": g.identical, "cosine": round(g.cosine, 6)} for g in groups])
        return 0
    for group in groups:
        print("equal files" if group.identical else f"same motion ({group.cosine:.3f})")
        for clip in group.ids:
            print(f"  {clip}")
    print(f"{len(groups)} {'group' if len(groups) == 1 else 'groups'} of duplicates")
    return 0


def describe(gallery: Gallery) -> dict[str, Any]:
    """What ``--json`` says of a gallery."""
    return {
        "gallery": str(gallery.folder),
        "source": None if gallery.source is None else str(gallery.source),
        "clips": len(gallery),
        "windows": len(gallery.windows),
        "hours": round(gallery.duration_s / 3600, 4),
        "precision": gallery.precision,
        "segments": len(gallery.segments),
        "model": {"name": gallery.model.name, "fingerprint": gallery.model.fingerprint},
        "captions": len(gallery.captions),
        "attributes": gallery.attributes is not None,
        "skipped": [{"path": skipped.path, "reason": skipped.reason} for skipped in gallery.skipped],
    }


def _finish(report: BuildReport, arguments: argparse.Namespace, seconds: float) -> int:
    gallery = report.gallery
    counts = {name: len(getattr(report, name)) for name in ("added", "changed", "unchanged", "removed")}
    if arguments.json:
        rates = {"seconds": round(seconds, 3), "indexed": report.indexed, "clips_per_s": round(report.clips_per_s, 2)}
        print_json({**describe(gallery), **counts, **rates})
    else:
        print(f"{gallery.folder}: {len(gallery)} clips, {len(gallery.windows)} windows, in {seconds:.1f} s")
        rate = f" ({report.indexed} indexed, {report.clips_per_s:.1f} clips/s)" if report.indexed else ""
        print(", ".join(f"{count} {name}" for name, count in counts.items()) + rate)
    say_skipped([(skipped.path, in_options(skipped.reason)) for skipped in gallery.skipped])
    return SOME_SKIPPED if gallery.skipped else 0


def _index(arguments: argparse.Namespace) -> int:
    """Files into a database."""
    report = runtime(arguments).index_into(
        str(arguments.folder), arguments.out, on=arguments.on, progress=Progress(), **reading(arguments)
    )
    counts = {name: getattr(report, name) for name in ("files", "unchanged", "clips", "windows")}
    if arguments.json:
        skipped = [{"path": failure.path, "reason": failure.reason} for failure in report.failures]
        rates = {"seconds": round(report.seconds, 3), "clips_per_s": round(report.clips_per_s, 2)}
        print_json({"library": arguments.out, **counts, **rates, "skipped": skipped})
    else:
        print(f"{report.clips} clips, {report.windows} windows indexed, in {report.seconds:.1f} s")
        print(f"{report.files} files, {report.unchanged} of them unchanged ({report.clips_per_s:.1f} clips/s)")
    say_skipped([(failure.path, in_options(failure.reason)) for failure in report.failures])
    return SOME_SKIPPED if report.failures else 0


def _place(text: str) -> Path | str:
    """A path of this machine, or an address as it is."""
    return text if "://" in text else Path(text)


def _jobs(arguments: argparse.Namespace) -> int:
    from motionrt.models.threads import usable_cpus

    return int(arguments.jobs) if arguments.jobs is not None else usable_cpus()
