"""Every file, and what the files make together, against torch: here, in processes of their own, or all there are."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from motionrt import Runtime
from motionrt.models import Manifest, Model, Variant, load_manifest
from motionrt_export.measures import Figures, beyond
from motionrt_export.optimise import FP32, QUANTISED
from motionrt_export.pipelines import PIPELINES
from motionrt_export.publish import Check, PipelineCheck, Proof, Say
from motionrt_export.sources import Sources
from motionrt_export.tolerances import pipeline_tolerance, tolerance
from motionrt_export.torch_runtime import TorchRuntime
from motionrt_export.validate import Subject, ValidationError, validate


def subject_of(
    sources: Sources, model: str, variant: str, file: Path, exact: Path | None = None, **sizes: Any
) -> Subject:
    """A file and everything that it is validated against; `sizes` are lengths and batches other than the usual."""
    limits, source = tolerance(model, variant), sources.source(model)
    return Subject(
        source.spec,
        file.read_bytes(),
        source.reference,
        source.examples,
        limits,
        source.scale,
        trial=source.trial,
        independent=variant != QUANTISED,
        exact=exact.read_bytes() if exact else None,
        **sizes,
    )


def validate_file(sources: Sources, model: str, variant: str, file: Path, exact: Path | None = None) -> Figures:
    """Worst figures of one file; raises ValidationError beyond the tolerance."""
    return validate(subject_of(sources, model, variant, file, exact))


def validate_pipeline(sources: Sources, pipeline: str, manifest: Path, **size: Any) -> dict[str, Figures]:
    """Figures of what the files of every variant make together; those that are not built are left out."""
    drift, found = PIPELINES[pipeline](TorchRuntime(sources), **size), load_manifest(manifest)
    built = [variant for variant in sorted(found.variants) if not _missing(found, variant)]
    return {variant: drift(Runtime(manifest, variant=variant, threads=1)) for variant in built}


def _missing(manifest: Manifest, variant: str) -> list[Path]:
    files = (manifest.locate(manifest.variant(name, variant).file) for name in manifest.models)
    return [path for path in files if not path.is_file()]


def apart(checkpoints: Path) -> Proof:
    """Proof by processes, so that no model sees what another left behind."""

    def file(model: str, variant: str, path: Path, exact: Path | None) -> Figures:
        options = {"--model": model, "--variant": variant, "--file": path, "--exact": exact}
        found: Figures = _run({**options, "--checkpoints": checkpoints}, f"{path}")
        return found

    def pipeline(name: str, manifest: Path) -> dict[str, Figures]:
        options = {"--pipeline": name, "--manifest": manifest, "--checkpoints": checkpoints}
        found: dict[str, Figures] = _run(options, name)
        return found

    return Proof(file, pipeline)


def _run(options: dict[str, object], name: str) -> Any:
    command = [sys.executable, "-m", "motionrt_export", "validate"]
    command += [str(part) for option, value in options.items() if value is not None for part in (option, value)]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", check=False)
    if done.returncode:
        raise ValidationError(done.stderr.strip().removeprefix("error: ") or f"{name}: validation crashed")
    return json.loads(done.stdout.splitlines()[-1])


def validate_all(manifest: Path, proof: Proof, say: Say) -> list[str]:
    """Validate every file that is there, and what they make together; gives what failed, in words.

    Files that are not shipped may be absent; nothing is written.
    """
    found, failed = load_manifest(manifest), []
    for model in found.models.values():
        for variant in model.variants.values():
            name = str(found.locate(variant.file))
            failed += _tried(partial(_file, found, model, variant, proof.file), name, say)
    for pipeline in PIPELINES:
        failed += _tried(partial(_pipeline, pipeline, manifest, proof.pipeline), pipeline, say)
    return failed


def _file(manifest: Manifest, model: Model, variant: Variant, check: Check) -> str:
    path = manifest.locate(variant.file)
    if not path.is_file():
        if variant.shipped:
            raise ValidationError("is missing")
        return "not built"
    exact = manifest.locate(model.variants[FP32].file) if FP32 in model.variants else path
    check(model.name, variant.name, path, exact if exact != path and exact.is_file() else None)
    return "within its tolerance"


def _pipeline(pipeline: str, manifest: Path, check: PipelineCheck) -> str:
    found = check(pipeline, manifest)
    for variant, figures in found.items():
        if broken := beyond(figures, pipeline_tolerance(pipeline, variant)):
            raise ValidationError(f"with the {variant} files: {'; '.join(broken)}")
    return f"within its tolerance with {', '.join(found) or 'no variant: files are not built'}"


def _tried(check: Callable[[], str], name: str, say: Say) -> list[str]:
    try:
        say(f"{name}: {check()}")
    except ValidationError as error:
        say(f"{name}: {error}")
        return [f"{name}: {error}"]
    return []
