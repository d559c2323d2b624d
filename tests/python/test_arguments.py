"""Messages name types with the article that English asks for."""
import re
from pathlib import Path

import numpy as np
import pytest
from apsis.arguments import type_of


@pytest.mark.parametrize("value, named", [
    (3, "an int"), (3.0, "a float"), ("a", "a str"), ([], "a list"), (np.zeros(1), "an ndarray"), (object(), "an object"),
    (np.uint8(3), "a uint8"), (None, "None"), (ValueError(), "a ValueError"), (OSError(), "an OSError")])
def test_types_have_their_article(value, named):
    assert type_of(value) == named


def test_no_message_has_an_article_of_its_own_before_a_type():
    folder = Path(__file__).resolve().parents[2] / "python" / "apsis"
    for file in folder.rglob("*.py"):
        assert not re.search(r"\b(a|an) \{type\(", file.read_text(encoding="utf-8")), file
