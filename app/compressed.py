"""Edge to the compressor: zstd, which changes how large a chunk of a recording is, not what it says."""

from __future__ import annotations

import struct
from collections.abc import Sequence

import zstandard

#: No chunk of a recording is larger; a damaged length must not ask for all memory.
LARGEST = 64 * 2**20
_LEVEL = 3


def pack(data: bytes) -> bytes:
    """The bytes as one zstd frame that knows its size."""
    return zstandard.ZstdCompressor(level=_LEVEL).compress(data)


def unpack_all(frames: Sequence[bytes], sizes: Sequence[int]) -> list[bytes | None]:
    """Each frame's bytes, of the size told; None for one that is damaged or says another size.

    All in one call of the compressor's, on two threads: a call for each would hand the interpreter's lock to
    whoever draws, thousands of times.
    """
    unpacked: list[bytes | None] = [None] * len(frames)
    good = [i for i, frame in enumerate(frames) if _says(frame, sizes[i])]
    if not good:  # the compressor crashes over no frame at all
        return unpacked
    told = struct.pack(f"={len(good)}Q", *(sizes[i] for i in good))
    try:
        made = zstandard.ZstdDecompressor().multi_decompress_to_buffer(
            [frames[i] for i in good], decompressed_sizes=told, threads=2
        )
        found: list[bytes | None] = [made[i].tobytes() for i in range(len(good))]
    except (zstandard.ZstdError, MemoryError, ValueError, TypeError):  # one of them, which does not say which
        found = [_unpack(frames[i], sizes[i]) for i in good]
    for i, data in zip(good, found, strict=True):
        unpacked[i] = data
    return unpacked


def _says(frame: bytes, size: int) -> bool:
    try:
        return 0 < size <= LARGEST and zstandard.frame_content_size(frame) == size
    except zstandard.ZstdError:
        return False


def _unpack(frame: bytes, size: int) -> bytes | None:
    try:
        data = zstandard.ZstdDecompressor().decompress(frame, max_output_size=size)
    except (zstandard.ZstdError, MemoryError):
        return None
    return data if len(data) == size else None
