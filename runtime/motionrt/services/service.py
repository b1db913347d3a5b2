"""What all services share: which models, opened how, once for all that are composed."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from motionrt.models.engine import Providers, checked_providers
from motionrt.models.sessions import Sessions
from motionrt.untrusted.arguments import check_kind, checked_whole
from motionrt.untrusted.files import as_path

if TYPE_CHECKING:
    from onnxruntime import SessionOptions

    from motionrt.models.text import SentenceEncoder


class Service:
    """Models that open when they are first needed.

    Args:
        models: the manifest or the folder of the models, by default those that came with motionrt.
        threads: threads of every model, by default at most 2 of those that the process may use.
        session_options: options for every onnxruntime session, instead of ``threads``.
        variant: which files of the models, as in ``fp32``, by default those that the manifest prefers; a model without
            such a file gives its preferred one (the pose prior has no ``int8``).
        providers: onnxruntime's execution providers of every session, the preferred one first, as in
            ``["CUDAExecutionProvider", "CPUExecutionProvider"]``; by default the CPU.
        text_tower: what embeds the texts of a search: ``"small"``, fast, or ``"full"``, which it was distilled from; by
            default the small one where the models have one. Galleries serve either.

    Raises:
        InvalidInputError: ``providers`` is no list of names, or of pairs of a name and options.
    """

    def __init__(
        self,
        models: str | Path | None = None,
        *,
        threads: int | None = None,
        session_options: SessionOptions | None = None,
        variant: str | None = None,
        providers: Providers | None = None,
        text_tower: str | None = None,
    ) -> None:
        if threads is not None:
            checked_whole(threads, "threads", 1)
        check_kind(variant, str | None, "variant", "a name, as in 'fp32'")
        check_kind(text_tower, str | None, "text_tower", "'small' or 'full'")
        if models is not None:
            as_path(models)
        self._models = models
        self._threads = threads
        self._session_options = session_options
        self._variant = variant
        self._providers = checked_providers(providers)
        self._text_tower = text_tower

    def __repr__(self) -> str:
        what = f"models={str(self._models)!r}" if self._models is not None else "the models that come with motionrt"
        opened = self.sessions.opened if "sessions" in vars(self) else []
        return f"{type(self).__name__}({what}; open: {', '.join(opened) or 'none yet'})"

    def _repr_html_(self) -> str:
        """A table of the models that come with it: their sizes, licences, and whether they are open; for notebooks."""
        from motionrt.motion.notebook import page, table

        rows = [
            [
                model.name,
                f"{variant.bytes / 1e6:.1f} MB",
                model.licence,
                "yes" if model.name in self.sessions.opened else "",
            ]
            for model in self.sessions.manifest.models.values()
            for variant in model.variants.values()
            if variant.shipped
        ]
        return page(repr(self), table(("model", "size", "licence", "open"), rows))

    @cached_property
    def sessions(self) -> Sessions:
        """All models of the manifest; each opens when it is first run."""
        return Sessions(
            self._models, threads=self._threads, session_options=self._session_options, providers=self._providers
        )

    @cached_property
    def sentences(self) -> SentenceEncoder:
        """The sentence encoder, which search and synthesis share."""
        from motionrt.models.text import SentenceEncoder

        return SentenceEncoder(self.sessions, self._variant)
