"""Documents in which something is not what it should be, for whatever reads JSON."""

import copy
from collections.abc import Sequence
from typing import Any

from hypothesis import strategies as st

_ODD = (10**400, -(10**19), "\ud800", "\x00", "a\nb", "1e999999999", "@goals", "@x", "in [", "/dev", "")
_values: st.SearchStrategy[Any] = st.recursive(
    st.one_of(
        st.none(),
        st.booleans(),
        st.integers(),
        st.floats(),
        st.text(max_size=9),
        st.sampled_from(_ODD),
    ),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=9), inner, max_size=3),
    max_leaves=5,
)


@st.composite
def damaged(draw: st.DrawFn, documents: Sequence[Any]) -> Any:
    """Return a document in which a part or two, or all of it, is something else."""
    root = [copy.deepcopy(draw(st.sampled_from(documents)))]
    for _ in range(draw(st.integers(1, 2))):
        at: Any = root
        key: Any = 0
        while isinstance(at[key], list | dict) and at[key] and draw(st.integers(0, 3)):
            at = at[key]
            key = draw(st.sampled_from(sorted(at) if isinstance(at, dict) else range(len(at))))
        at[key] = draw(_values)
    return root[0]
