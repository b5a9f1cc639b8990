"""Edge to the compressor: zstd, which changes how large a chunk of a recording is, not what it says."""

from __future__ import annotations

import zstandard

#: No chunk of a recording is larger; a damaged length must not ask for all memory.
LARGEST = 64 * 2**20
_LEVEL = 3


def pack(data: bytes) -> bytes:
    """The bytes as one zstd frame that knows its size."""
    return zstandard.ZstdCompressor(level=_LEVEL).compress(data)


class Unpacker:
    """Unpacks frames, one after the other; to be used by one thread."""

    def __init__(self) -> None:
        self._decompressor = zstandard.ZstdDecompressor()

    def __call__(self, frame: bytes, size: int) -> bytes | None:
        """The ``size`` bytes of a frame; None if it is damaged or says another size."""
        try:
            if size > LARGEST or zstandard.frame_content_size(frame) != size:
                return None
            data = self._decompressor.decompress(frame, max_output_size=max(size, 1))
        except (zstandard.ZstdError, MemoryError):
            return None
        return data if len(data) == size else None
