"""Tables as data frames, where pandas is installed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

if TYPE_CHECKING:
    import pandas


def data_frame(columns: Mapping[str, Sequence[Any] | NDArray[Any]]) -> pandas.DataFrame:
    """A data frame of `columns`, all of one length; ImportError with what to install where pandas is missing."""
    try:
        import pandas
    except ImportError:
        raise ImportError(
            "A table needs pandas, which is not installed. Install it with pip install 'pierburg_ros[tables]'."
        ) from None
    return pandas.DataFrame(dict(columns))
