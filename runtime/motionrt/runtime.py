"""``Runtime``: one object, its verbs are the product."""

from __future__ import annotations

from motionrt.services.locomotion import Locomotion
from motionrt.services.search import Search
from motionrt.services.synthesis import Synthesis


class Runtime(Search, Locomotion, Synthesis):
    """Search, describe and embed motion, make it of words, walk and act; every model opens when it is first needed.

    It is composed of the services of :mod:`motionrt.services`, which a program that needs one alone can use alone.

    Args:
        models: the manifest or the folder of the models, by default those that came with motionrt.
        threads: threads of every model, by default at most 2 of those that the process may use.
        session_options: options for every onnxruntime session, instead of ``threads``.
        variant: which files of the models, as in ``fp32``, by default those that the manifest prefers; a model without
            such a file gives its preferred one (the pose prior has no ``int8``).
        providers: onnxruntime's execution providers of every session, the preferred one first, as in
            ``["CUDAExecutionProvider", "CPUExecutionProvider"]``; by default the CPU.

    Raises:
        InvalidInputError: ``providers`` is no list of names, or of pairs of a name and options.
    """
