"""Door: what was let in and what was refused, as numbers."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field


@dataclass
class Counters:
    """Written on the door's thread only; anyone may read."""

    connections: int = 0  # browsers connected now
    connections_total: int = 0
    refused_host: int = 0
    refused_origin: int = 0
    refused_token: int = 0
    refused_full: int = 0  # too many connections
    closed_malformed: int = 0  # connections ended for a message that is none
    closed_too_big: int = 0
    closed_stalled: int = 0  # browsers that took nothing for a while
    messages_in: int = 0  # handed to viser
    messages_out: int = 0
    bytes_out: int = 0
    paced: int = 0  # times that a browser that talked too fast was made to wait
    dropped_messages: Counter[str] = field(default_factory=Counter)  # message type → how many

    def refuse(self, what: str) -> None:
        """Count one refusal: ``host``, ``origin``, ``token`` or ``full``."""
        name = f"refused_{what}"
        setattr(self, name, getattr(self, name) + 1)
