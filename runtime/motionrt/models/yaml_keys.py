"""A safe YAML loader that refuses a key that stands in a mapping twice, where YAML's own takes the last one."""

from __future__ import annotations

from typing import Any


def unique_keys(yaml: Any) -> Any:
    """The loader class; ``yaml`` is the module, which is only imported where a file is read."""
    base = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

    class UniqueKeys(base):  # type: ignore[misc,valid-type]
        """Mappings are read by `mapping`."""

    def mapping(loader: Any, node: Any) -> dict[Any, Any]:
        seen = set()
        for key, _ in node.value:
            name = str(key.value)
            if name in seen:
                problem = f"the key '{name}' stands there twice; remove one"
                raise yaml.constructor.ConstructorError("in a mapping", node.start_mark, problem, key.start_mark)
            seen.add(name)
        found: dict[Any, Any] = loader.construct_mapping(node, deep=True)
        return found

    UniqueKeys.add_constructor(yaml.resolver.BaseResolver.DEFAULT_MAPPING_TAG, mapping)
    return UniqueKeys
