"""onnxruntime, whichever of its packages is installed, and sessions on the providers that the caller chose."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from motionrt.errors import InvalidInputError, MissingDependencyError

if TYPE_CHECKING:
    from onnxruntime import InferenceSession, SessionOptions

Provider = str | tuple[str, Mapping[str, Any]]
Providers = Sequence[Provider]
CPU: tuple[Provider, ...] = ("CPUExecutionProvider",)


def checked_providers(providers: Providers | None) -> tuple[Provider, ...]:
    """``providers`` as a tuple, by default the CPU.

    Raises:
        InvalidInputError: not a list, an empty one, or one of something else than names or (name, options).
    """
    if providers is None:
        return CPU
    if isinstance(providers, str | bytes) or not isinstance(providers, Sequence) or not providers:
        raise InvalidInputError(f"providers is a list of names, as in ['CPUExecutionProvider'], not {providers!r}")
    if wrong := [provider for provider in providers if not _is_provider(provider)]:
        raise InvalidInputError(f"a provider is a name or a pair (name, options), not {wrong[0]!r}")
    return tuple(providers)


def engine() -> Any:
    """The module ``onnxruntime``.

    Raises:
        MissingDependencyError: no package that has it is installed, or it cannot be loaded; says what to install.
    """
    try:
        import onnxruntime
    except ImportError as error:
        raise MissingDependencyError(
            f"no onnxruntime can be loaded ({error}); install one of its packages: pip install onnxruntime, "
            "or onnxruntime-gpu, onnxruntime-directml, onnxruntime-openvino in its place"
        ) from error
    return onnxruntime


def open_session(model: str | bytes, options: SessionOptions, providers: Providers = CPU) -> InferenceSession:
    """A session of a model, given as its path or its bytes.

    Raises:
        MissingDependencyError: there is no onnxruntime.
        InvalidInputError: the installed onnxruntime has none of that name; lists those that it has.
    """
    onnxruntime = engine()
    names = [provider if isinstance(provider, str) else provider[0] for provider in providers]
    there = onnxruntime.get_available_providers()
    if absent := [name for name in names if name not in there]:
        raise InvalidInputError(
            f"the installed onnxruntime {onnxruntime.__version__} has no provider {', '.join(absent)}; "
            f"it has: {', '.join(there)}"
        )
    session: InferenceSession = onnxruntime.InferenceSession(model, options, providers=list(providers))
    return session


def _is_provider(provider: object) -> bool:
    if isinstance(provider, str):
        return True
    pair = isinstance(provider, tuple) and len(provider) == 2
    return pair and isinstance(provider[0], str) and isinstance(provider[1], Mapping)  # type: ignore[index]
