"""Feature vectors, each defined once: those of the papers (``sinc135``, ``ccf219``, ``guo263``), and ``ego77``."""
