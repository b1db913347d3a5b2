"""ONNX sessions: opened when first used, once each, from verified files, with few and quiet threads."""

from __future__ import annotations

import threading
from collections import defaultdict
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from motionrt.models.checks import verified
from motionrt.models.engine import Providers, checked_providers, engine, open_session
from motionrt.models.locate import find_manifest
from motionrt.models.manifest import Manifest, Model, Variant
from motionrt.models.reading import load_manifest
from motionrt.models.threads import thread_count

if TYPE_CHECKING:
    from onnxruntime import InferenceSession, SessionOptions

Arrays = Mapping[str, npt.NDArray[Any]]


class Sessions:
    """The models of one manifest, ready to run; may be used from several threads.

    Args:
        models: the manifest or its folder; None takes those that came with motionrt.
        threads: threads of every session, by default at most 2 of those that the process may use.
        session_options: options for every session, instead of ``threads``.
        providers: onnxruntime's execution providers of every session, the preferred one first; by default the CPU.

    Raises:
        ModelFileError, ManifestError: no manifest, or a bad one.
        InvalidInputError: ``threads`` is not a whole number above 0, or ``providers`` is no list of providers.
    """

    def __init__(
        self,
        models: str | Path | None = None,
        *,
        threads: int | None = None,
        session_options: SessionOptions | None = None,
        providers: Providers | None = None,
    ) -> None:
        self.providers = checked_providers(providers)
        self.manifest: Manifest = load_manifest(find_manifest(models))
        self.threads = thread_count(threads)
        self._options = session_options
        self._opened: dict[tuple[str, str], InferenceSession] = {}
        self._prepared: set[tuple[str, str | None]] = set()
        self._locks: defaultdict[tuple[str, str], threading.Lock] = defaultdict(threading.Lock)
        self._lock = threading.Lock()

    @property
    def opened(self) -> list[str]:
        """Names of the models that are open."""
        return sorted({name for name, _ in self._opened})

    def model(self, name: str) -> Model:
        """What the manifest says of a model."""
        return self.manifest.model(name)

    def session(self, model: str, variant: str | None = None) -> InferenceSession:
        """The session of a variant, opened at the first call; which one a name means: :meth:`Manifest.variant`.

        Raises:
            ModelNotFoundError: no such model or variant.
            ModelFileError, ChecksumError: its file is missing, or not the one that the manifest means.
        """
        chosen = self.manifest.variant(model, variant)
        key = model, chosen.name
        with self._lock:
            lock = self._locks[key]
        with lock:
            if key not in self._opened:
                self._opened[key] = self._open_verified(chosen)
            return self._opened[key]

    def prepare(self, *models: str, variant: str | None = None) -> None:
        """Start to open models in the background, once; what goes wrong is raised when their session is asked for."""
        engine()  # once, before the threads ask for it together
        for model in models:
            if (model, variant) not in self._prepared:
                self._prepared.add((model, variant))
                threading.Thread(target=self._try_to_open, args=(model, variant)).start()

    def run(
        self, model: str, outputs: list[str], feeds: Arrays, variant: str | None = None
    ) -> list[npt.NDArray[np.float32]]:
        """Run a model and give the named outputs, in that order; switches that are not given are on."""
        session = self.session(model, variant)
        results: list[npt.NDArray[np.float32]] = session.run(outputs, {**switches_on(session), **feeds})
        return results

    def _try_to_open(self, model: str, variant: str | None) -> None:
        with suppress(Exception):
            self.session(model, variant)

    def _open_verified(self, chosen: Variant) -> InferenceSession:
        """A session of the very bytes whose checksum is the right one."""
        content = verified(self.manifest, chosen)
        options = self._options if self._options is not None else quiet_options(self.threads)
        return open_session(content, options, self.providers)


def switches_on(session: InferenceSession) -> dict[str, npt.NDArray[np.bool_]]:
    """True for every input that is a single bool: ``embed`` of the text model."""
    inputs = session.get_inputs()
    return {info.name: np.array(True) for info in inputs if info.type == "tensor(bool)" and not info.shape}


def quiet_options(threads: int) -> SessionOptions:
    """Options for a guest in somebody else's process: no spinning, no warnings, one operator at a time.

    Memory patterns are off: they are kept for every new length of input, and bring nothing here.
    """
    options: SessionOptions = engine().SessionOptions()
    options.intra_op_num_threads = threads
    options.inter_op_num_threads = 1
    options.enable_mem_pattern = False
    options.log_severity_level = 3
    options.add_session_config_entry("session.intra_op.allow_spinning", "0")
    options.add_session_config_entry("session.inter_op.allow_spinning", "0")
    return options
