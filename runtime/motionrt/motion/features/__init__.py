"""The three feature vectors of the papers, each defined once: ``sinc135``, ``ccf219`` and ``guo263``."""
