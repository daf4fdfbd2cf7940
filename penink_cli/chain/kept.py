"""What filters have made, remembered from one drawing to the next while a drawing follows its files."""

from __future__ import annotations

from penink_cli.ground import streams
from penink_cli.ground.changes import State, note


class Kept:
    """What filters have made of what: while that is the same, they need not run again."""

    def __init__(self) -> None:
        self._made: dict[tuple[str, ...], tuple[dict[str, State], bytes]] = {}
        self._used: set[tuple[str, ...]] = set()

    def made(self, call: tuple[str, ...]) -> bytes | None:
        """What a call made, if nothing that it read has changed."""
        read, result = self._made.get(call, ({}, None))
        if result is None or any(streams.state(path) != state for path, state in read.items()):
            return None
        for path, state in read.items():
            note(path, state)
        self._used.add(call)
        return result

    def keep(self, call: tuple[str, ...], read: dict[str, State], result: bytes) -> None:
        """Remember what a call has read and made."""
        self._made[call] = read, result
        self._used.add(call)

    def forget_others(self) -> None:
        """Forget what nobody has asked for since the last time."""
        self._made = {call: made for call, made in self._made.items() if call in self._used}
        self._used = set()
