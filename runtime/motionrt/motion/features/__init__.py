"""Feature vectors, each defined once: ``sinc135``, ``ccf219`` and ``guo263`` of the papers, ``ego77`` of the generator."""
