"""What is made of the same things twice is made once, where that is asked for."""

import numpy as np

from penink_cli.ground.recall import MOST, recalled, remembering


def test_only_the_same_is_recalled_and_only_where_it_is_asked_for():
    made = []

    def make(*told):
        return recalled("sums", told, lambda: made.append(told) or float(np.sum(told[0])))

    assert make(np.arange(3.0)) == make(np.arange(3.0)) == 3.0 and len(made) == 2
    with remembering():
        assert [make(np.arange(n)) for n in (3, 4, 3, 4)] == [3.0, 6.0, 3.0, 6.0]
        assert len(made) == 4
        make(np.arange(3), "told more")
        make(np.arange(3.0))  # of another type
        assert len(made) == 6
        assert recalled("others", (np.arange(3),), lambda: "another") == "another"
        for n in range(10, 10 + MOST):
            make(np.arange(n))
        make(np.arange(10))
        assert len(made) == 6 + MOST
        make(np.arange(3))  # forgotten
        assert len(made) == 7 + MOST
    make(np.arange(3))
    assert len(made) == 8 + MOST
