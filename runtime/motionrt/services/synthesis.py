"""The service that makes motion: generate, compose, layers, body_parts."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, lru_cache, partial
from typing import TYPE_CHECKING, overload

from motionrt.services.service import Service
from motionrt.synthesis.sampling import DEFAULT_SAMPLER, SECONDS

if TYPE_CHECKING:
    from motionrt.models.text import FloatArray
    from motionrt.motion import Motion
    from motionrt.synthesis.choosing import Likeness
    from motionrt.synthesis.composing.alignment import Align
    from motionrt.synthesis.composing.composition import Keep
    from motionrt.synthesis.composing.layers import Layer
    from motionrt.synthesis.constraints import Constraints
    from motionrt.synthesis.generating import Generator
    from motionrt.synthesis.layering import LayerLike, Names
    from motionrt.synthesis.motion_stream import MotionStream
    from motionrt.synthesis.parts import Complete, Endpoint, Labeller
    from motionrt.synthesis.timeline import Item


class Synthesis(Service):
    """Text to motion, composition of motions, and the body parts of action texts; its arguments are those of
    :class:`motionrt.Runtime`.
    """

    @cached_property
    def generator(self) -> Generator:
        """Text to motion; its models open when they are first needed."""
        from motionrt.synthesis.generating import Generator

        return Generator(self.sessions, self._variant, sentences=self.sentences)

    @overload  # a str is a sequence of str, too, so the first two overlap the others
    def generate(  # type: ignore[overload-overlap]
        self,
        text: str,
        seconds: float = ...,
        *,
        n: None = ...,
        seed: int | None = ...,
        temperature: float = ...,
        sampler: str = ...,
        guidance: float | None = ...,
        steps: int | None = ...,
        foot_lock: bool = ...,
        constraints: Constraints | None = ...,
        loop: bool = ...,
        in_place: bool = ...,
        candidates: int = ...,
    ) -> Motion: ...

    @overload
    def generate(  # type: ignore[overload-overlap]
        self,
        text: str,
        seconds: float = ...,
        *,
        n: int,
        seed: int | None = ...,
        temperature: float = ...,
        sampler: str = ...,
        guidance: float | None = ...,
        steps: int | None = ...,
        foot_lock: bool = ...,
        constraints: Constraints | None = ...,
        loop: bool = ...,
        in_place: bool = ...,
        candidates: int = ...,
    ) -> list[Motion]: ...

    @overload
    def generate(
        self,
        text: None = ...,
        seconds: float = ...,
        *,
        timeline: Sequence[Item],
        n: None = ...,
        seed: int | None = ...,
        temperature: float = ...,
        guidance: float | None = ...,
        steps: int | None = ...,
        foot_lock: bool = ...,
        constraints: Constraints | None = ...,
        in_place: bool = ...,
        candidates: int = ...,
    ) -> Motion: ...

    @overload
    def generate(
        self,
        text: None = ...,
        seconds: float = ...,
        *,
        timeline: Sequence[Item],
        n: int,
        seed: int | None = ...,
        temperature: float = ...,
        guidance: float | None = ...,
        steps: int | None = ...,
        foot_lock: bool = ...,
        constraints: Constraints | None = ...,
        in_place: bool = ...,
        candidates: int = ...,
    ) -> list[Motion]: ...

    @overload
    def generate(
        self,
        text: Sequence[str],
        seconds: float = ...,
        *,
        n: None = ...,
        seed: int | None = ...,
        temperature: float = ...,
        sampler: str = ...,
        guidance: float | None = ...,
        steps: int | None = ...,
        foot_lock: bool = ...,
        constraints: Constraints | None = ...,
        loop: bool = ...,
        in_place: bool = ...,
        candidates: int = ...,
    ) -> list[Motion]: ...

    @overload
    def generate(
        self,
        text: Sequence[str],
        seconds: float = ...,
        *,
        n: int,
        seed: int | None = ...,
        temperature: float = ...,
        sampler: str = ...,
        guidance: float | None = ...,
        steps: int | None = ...,
        foot_lock: bool = ...,
        constraints: Constraints | None = ...,
        loop: bool = ...,
        in_place: bool = ...,
        candidates: int = ...,
    ) -> list[list[Motion]]: ...

    def generate(
        self,
        text: str | Sequence[str] | None = None,
        seconds: float = SECONDS,
        *,
        n: int | None = None,
        seed: int | None = None,
        temperature: float = 1.0,
        sampler: str = DEFAULT_SAMPLER,
        guidance: float | None = None,
        steps: int | None = None,
        foot_lock: bool = True,
        timeline: Sequence[Item] | None = None,
        constraints: Constraints | None = None,
        loop: bool = False,
        in_place: bool = False,
        candidates: int = 1,
    ) -> Motion | list[Motion] | list[list[Motion]]:
        """A motion that a text describes; or several, or those of several texts; or of several texts in one motion.

        Motions have 30 fps and begin above the origin, facing +Z, with the floor at y = 0. Sample ``i`` of a text and a
        seed is the same, bit for bit, whatever else is asked for with it.

        Args:
            text: what somebody does, as in "wave the right hand"; a list of texts gives a list of answers.
            seconds: 0.5 to 10; 8 at most for the samplers "diffusion" and "vae".
            n: how many motions of each text, as a list; None is one, not in a list.
            seed: of the chance in it, from 0; None is another one every time.
            temperature: how far samples stray from what is most likely: 1 as trained, 0 not at all, so that all are
                the same.
            sampler: ``"motion"``, diffusion in motion space; ``"diffusion"``, latent diffusion; or ``"vae"``, which
                draws straight from the text encoder's distribution.
            guidance: how much more the text counts than in training, for diffusion; None takes the sampler's own.
            steps: calls of the denoiser, for diffusion: fewer are faster; None takes the sampler's own.
            foot_lock: let standing feet stand still.
            timeline: instead of a text, texts one after another and at once: ``[("walk", 3), ("sit down", 2)]`` or
                ``{"text": "wave", "from": 1, "to": 3, "parts": "right arm"}``; of any length.
            constraints: poses, places, hands and feet, or a clip to keep to.
            loop: end where it begins, pose and velocity, so that it can be played on and on.
            in_place: without its way over the ground.
            candidates: draw so many of each and keep the one that does best what its text says, by measuring and by
                the retrieval model; 1 to 64. Candidate ``j`` of motion ``i`` is sample ``i * candidates + j``.

        Raises:
            InvalidInputError: an empty text, or a number out of range; the message says what is possible.
            ModelNotFoundError, ModelFileError: the models are not there.
        """
        from motionrt.errors import InvalidInputError
        from motionrt.models.text import checked_text
        from motionrt.synthesis.asking import Asked
        from motionrt.synthesis.sampling import Sampling
        from motionrt.untrusted.arguments import listed

        how = Sampling(seconds, seed, 1 if n is None else n, temperature, sampler, guidance, steps, foot_lock)
        asked = Asked(how, constraints, loop, in_place, candidates)
        if (text is None) == (timeline is None):
            raise InvalidInputError("give a text or a timeline, one of them")
        one = timeline if timeline is not None else text if isinstance(text, str) else None
        if one is not None:
            lines = asked.lines(one, self.body_parts)
            found = asked.answer(lines, self.generator, self._likeness)
            return found[0] if n is None else found
        texts = listed(text, "text", "texts")
        if not texts:
            raise InvalidInputError("give at least one text")
        read = [asked.lines(checked_text(each), self.body_parts) for each in texts]  # all, before one is answered
        many = [asked.answer(lines, self.generator, self._likeness) for lines in read]
        return [motions[0] for motions in many] if n is None else many

    def converse(
        self,
        text: str,
        *,
        seed: int | None = None,
        temperature: float = 1.0,
        guidance: float | None = None,
        steps: int | None = None,
        foot_lock: bool = True,
    ) -> MotionStream:
        """Motion without an end: every ``next()`` gives two seconds more, and ``say(text)`` changes what is done.

        Args:
            text: what is done first.
            seed: as for :meth:`generate`.
            temperature: as there.
            guidance: as there.
            steps: as there.
            foot_lock: as there.

        Raises:
            InvalidInputError: an empty text, or a number out of range.
            ModelNotFoundError, ModelFileError: the models are not there.
        """
        from motionrt.synthesis.motion_stream import MotionStream
        from motionrt.synthesis.sampling import Sampling

        how = Sampling(SECONDS, seed, 1, temperature, "motion", guidance, steps, foot_lock)
        return MotionStream(self.generator.in_motion_space, text, how)

    @cached_property
    def _likeness(self) -> Likeness:
        """Cosine of a text and a motion by the retrieval model; nothing where the models have none."""
        from motionrt.models.tmr import MOTION, TextMotionModel
        from motionrt.motion.features import guo263

        if MOTION not in self.sessions.manifest.models:
            return lambda _text, _motion: 0.0
        model = TextMotionModel(self.sessions, variant=self._variant, sentences=self.sentences)

        @lru_cache(maxsize=16)
        def embedded(text: str) -> FloatArray:
            row: FloatArray = model.embed_text([text])[0]
            return row

        return lambda text, motion: float(embedded(text) @ model.embed_motion([guo263.encode(motion)])[0])

    def layers(
        self,
        given: Sequence[LayerLike],
        parts: Sequence[Names] | None = None,
        *,
        masks: Sequence[Names] | None = None,
        seconds: float | None = None,
        seed: int | None = None,
        labeller: str | Labeller = "rules",
        sampler: str = DEFAULT_SAMPLER,
        temperature: float = 1.0,
    ) -> list[Layer]:
        """What :meth:`compose` lays over each other, with motions generated and parts found; arguments as there."""
        from motionrt.synthesis.layering import Makers, layers_of
        from motionrt.synthesis.sampling import Sampling

        how = Sampling(seed=seed, sampler=sampler, temperature=temperature)
        makers = Makers(
            make=lambda text, length: self.generator.generate(text, how.with_seconds(length))[0],
            label=partial(self.body_parts, labeller=labeller),
            derive=_fast_parts,
        )
        return layers_of(given, makers, parts=parts, masks=masks, seconds=seconds)

    def compose(
        self,
        given: Sequence[LayerLike],
        parts: Sequence[Names] | None = None,
        *,
        masks: Sequence[Names] | None = None,
        seconds: float | None = None,
        seed: int | None = None,
        joint: bool = False,
        align: Align = "start",
        seam: int = 1,
        keep: Keep = "local",
        foot_lock: bool = False,
        override: bool = True,
        labeller: str | Labeller = "rules",
        sampler: str = DEFAULT_SAMPLER,
        temperature: float = 1.0,
    ) -> Motion:
        """One motion out of several: each moves some parts of the body (SINC 3.1).

        Whoever needs fewer parts lies on top; a leg or "global" takes both legs, the global orientation and the
        translation along; see :func:`motionrt.synthesis.composing.compose`.

        Args:
            given: two or more motions, motion files, texts, or :class:`~motionrt.synthesis.composing.Layer` s. A
                ``str`` is a file if there is one, or if it is named like one (``wave.bvh``); otherwise a text.
            parts: for each the body parts that its action needs, as in ``[None, "right arm"]``. Those left open are
                found: of texts by the labeller, of motions by how fast they move, without legs and "global", or
                arms and torso where nothing else is left; a first motion that is left open moves all that the others
                leave.
            masks: for each exactly the joints that it moves, names of parts or joints, instead of ``parts``.
            seconds: length; None is that of the shortest motion, or 4 s where all are texts. Longer ones are cut,
                shorter ones looped.
            seed: for texts: as in :meth:`generate`, every text with this seed.
            joint: all are texts, and the model gets them in one sentence, as SINC is trained; nothing is composed
                afterwards. Otherwise every text is generated by itself.
            align: ``"start"``, ``"stretch"`` (everyone's end at the same time) or ``"phase"`` (in step).
            seam: over how many joints one layer passes into another, 0 to 3; 0 is the paper's hard cut.
            keep: ``"world"`` keeps the lean of what is moved to another body, ``"local"`` its joints' rotations.
            foot_lock: let standing feet of the result stand still; those of generated texts do already.
            override: where two need the same part, the one on top gets it; otherwise this is an error.
            labeller: finds the parts of texts: ``"rules"``, or any function of a text, such as a
                :class:`~motionrt.synthesis.parts.PromptLabeller`.
            sampler: as in :meth:`generate`.
            temperature: as in :meth:`generate`.

        Raises:
            InvalidInputError: anything of the wrong kind or out of range; the message says which and what is possible.
            MotionFileNotFoundError, FormatError, RigError: a file that cannot be read.
        """
        from motionrt.synthesis.composing import compose
        from motionrt.synthesis.layering import joined
        from motionrt.untrusted.arguments import check_flags

        check_flags(joint=joint)
        if joint:
            text = joined(given, parts, masks)
            length = SECONDS if seconds is None else seconds
            return self.generate(text, length, seed=seed, sampler=sampler, temperature=temperature)
        layers = self.layers(
            given,
            parts,
            masks=masks,
            seconds=seconds,
            seed=seed,
            labeller=labeller,
            sampler=sampler,
            temperature=temperature,
        )
        return compose(
            layers, seconds=seconds, align=align, seam=seam, keep=keep, foot_lock=foot_lock, override=override
        )

    def body_parts(
        self,
        text: str,
        *,
        labeller: str | Labeller = "rules",
        complete: Complete | None = None,
        endpoint: Endpoint | None = None,
    ) -> frozenset[str]:
        """The body parts that an action needs, out of the six of :data:`motionrt.PARTS`.

        Args:
            text: what somebody does, as in "kick with the right leg".
            labeller: ``"rules"``, offline; ``"llm"``, a language model of yours; or any function of a text that gives
                names of parts.
            complete: for ``"llm"``: any function that answers a prompt.
            endpoint: for ``"llm"``, instead: where an OpenAI-compatible server answers it.

        Raises:
            InvalidInputError: an empty text, an unknown labeller, or ``"llm"`` without a model.
            LabellingError: the language model gives no answer, or names no part.
        """
        from motionrt.synthesis.parts import body_parts

        return body_parts(text, labeller=labeller, complete=complete, endpoint=endpoint)


def _fast_parts(motion: Motion) -> frozenset[str]:
    """The parts that a motion moves, by their speed."""
    from motionrt.synthesis.parts import velocity_parts

    return velocity_parts(motion)
