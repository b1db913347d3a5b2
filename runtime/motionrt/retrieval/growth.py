"""Which segments of a gallery are written anew when it grows or shrinks: few, and never many small ones.

A new segment swallows those that are small beside it, so that a gallery has a handful of segments, and every clip is
written again a few times in all, however often clips are added (the rule of log-structured merge trees).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from motionrt.retrieval.merging import Numbers, merged
from motionrt.retrieval.segments import Segment

SMALL = 10_000  # windows of a segment that costs nothing to write again
_TIMES = 2  # a segment is swallowed that has at most so many times the windows of the new one


def settled(changed: Sequence[Segment], unchanged: Sequence[Segment], fresh: Sequence[Segment]) -> list[Segment]:
    """The segments of a gallery from now on.

    Args:
        changed: segments of which clips were deleted or stamped anew.
        unchanged: the others that there are.
        fresh: what is new.
    """
    swallowed = [part for part in changed if part.window_count <= SMALL or _mostly_gone(part)]
    kept = [part for part in changed if part not in swallowed] + list(unchanged)
    if swallowed or fresh:
        while True:
            size = max(SMALL, _TIMES * sum(part.window_count for part in [*fresh, *swallowed]))
            more = [part for part in kept if part.window_count <= size]
            if not more:
                break
            swallowed += more
            kept = [part for part in kept if part not in more]
    together = [part for part in [*swallowed, *fresh] if part.clip_count]
    return kept + ([merged(together)] if together else [])


def without(part: Segment, numbers: Numbers) -> Segment:
    """A segment without the clips of those numbers."""
    deleted = np.union1d(part.deleted, numbers).astype(np.uint32)
    return replace(part, deleted=deleted, files={role: name for role, name in part.files.items() if role != "deleted"})


def _mostly_gone(part: Segment) -> bool:
    return 2 * part.clip_count < len(part.clips)
