"""Results of filters, remembered from one drawing to the next where `draw --watch` draws again."""

from __future__ import annotations

from penink_cli.ground import streams
from penink_cli.ground.changes import State, note


class Kept:
    """Results of filters by their calls, with the inputs that each read; while these are the same, none runs again."""

    def __init__(self) -> None:
        self._made: dict[tuple[str, ...], tuple[dict[str, State], bytes]] = {}
        self._used: set[tuple[str, ...]] = set()

    def made(self, call: tuple[str, ...]) -> bytes | None:
        """The result of a call, None where there is none or an input has changed since."""
        read, result = self._made.get(call, ({}, None))
        if result is None or any(streams.state(path) != state for path, state in read.items()):
            return None
        for path, state in read.items():
            note(path, state)
        self._used.add(call)
        return result

    def keep(self, call: tuple[str, ...], read: dict[str, State], result: bytes) -> None:
        """Remember the inputs and the result of a call."""
        self._made[call] = read, result
        self._used.add(call)

    def forget_others(self) -> None:
        """Forget the results that nothing has asked for since this was called last."""
        self._made = {call: made for call, made in self._made.items() if call in self._used}
        self._used = set()
