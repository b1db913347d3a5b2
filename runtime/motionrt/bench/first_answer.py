"""A fresh process up to its first answers; prints a line for each, with the peak memory so far."""

from __future__ import annotations

import json
import sys


def main() -> int:
    """``first_answer.py '{"models": null, "threads": 1}'``."""
    import numpy as np

    from motionrt.runtime import Runtime

    runtime = Runtime(**json.loads(sys.argv[1]))
    runtime.embed_text("a person walks in a circle")
    print(json.dumps({"text_mb": peak_mb()}), flush=True)
    runtime.model.embed_motion([np.zeros((200, 263), np.float32)])
    print(json.dumps({"motion_mb": peak_mb()}), flush=True)
    return 0


def peak_mb() -> float | None:
    """The most memory this process has held, in MB; ``None`` where the system does not say."""
    try:
        import resource
    except ImportError:  # Windows
        return None
    unit = 1 if sys.platform == "darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 1e6


if __name__ == "__main__":
    sys.exit(main())
