"""Edge to the compiler: the only importer of numba, and where its cache lives.

numba's own cache lies beside the sources and does not notice a change in a *called* function of
another file. So before numba is imported its cache is sent to a per-user folder whose name is a
hash of every source that holds kernels and of the numba version; where no such folder can be
written, to a temporary one.
"""

from __future__ import annotations

import hashlib
import importlib.metadata
import os
import platform
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import ParamSpec, TypeVar

import platformdirs

_P = ParamSpec("_P")
_R = TypeVar("_R")
_APP = Path(__file__).parent


def sources_hash(root: Path = _APP) -> str:
    """A short hash of all sources that hold kernels, of numba's version and of Python's."""
    digest = hashlib.sha256(f"{importlib.metadata.version('numba')} {platform.python_version()}".encode())
    for path in sorted(root.rglob("*.py")):
        source = path.read_bytes()
        if b"app.compiled" in source or path == root / "compiled.py":
            digest.update(str(path.relative_to(root)).encode() + b"\0" + source)
    return digest.hexdigest()[:16]


def choose_cache_folder(name: str) -> Path:
    """A writable folder for compiled kernels: the user's, or else a temporary one."""
    folder = Path(platformdirs.user_cache_dir("stridescope", appauthor=False)) / "kernels" / name
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError:
        return Path(tempfile.mkdtemp(prefix="stridescope-kernels-"))
    return folder


os.environ["NUMBA_CACHE_DIR"] = str(choose_cache_folder(sources_hash()))

import numba  # noqa: E402  (the folder has to be known first)


def kernel(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """Compile ``function`` on its first call, cached, without the interpreter lock."""
    return numba.njit(cache=True, nogil=True, fastmath=False, parallel=False)(function)


def is_compiled(function: Callable[..., object]) -> bool:
    """Whether ``function`` has been compiled or loaded in this process."""
    return bool(getattr(function, "signatures", ()))
