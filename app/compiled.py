"""Edge to the compiler: the only importer of numba, and where its cache lives.

numba's own cache lies beside the sources and does not notice a change in another file: in a *called*
function, or in a constant that a kernel froze. So before numba is imported its cache is sent to a
per-user folder whose name is a hash of every source a kernel can see and of the numba version; where
no such folder can be written, to a temporary one that goes at exit, or nothing is kept.
"""

from __future__ import annotations

import ast
import atexit
import contextlib
import hashlib
import importlib.metadata
import logging
import os
import platform
import re
import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import platformdirs

_P = ParamSpec("_P")
_R = TypeVar("_R")
_APP = Path(__file__).parent
_log = logging.getLogger(__name__)

#: Every version leaves a folder of kernels; one that no start has used for so long is removed.
FORGOTTEN_S = 60 * 86_400.0


def _imported(path: Path, root: Path) -> list[Path]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(path.read_bytes())):
        if isinstance(node, ast.ImportFrom):
            names |= {f"{node.module}", *(f"{node.module}.{alias.name}" for alias in node.names)}
        elif isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
    parts = (name.split(".") for name in names)
    files = (root.joinpath(*part[1:]).with_suffix(".py") for part in parts if part[0] == "app" and part[1:])
    return [file for file in files if file.is_file()]


def kernel_sources(root: Path) -> list[Path]:
    """The files that hold kernels, and all of ours that those import, directly or not."""
    waiting = [path for path in root.rglob("*.py") if re.search(rb"@kernel\b|\bkernel\(", path.read_bytes())]
    found: set[Path] = set()
    while waiting:
        path = waiting.pop()
        if path not in found:
            found.add(path)
            waiting += _imported(path, root)
    return sorted(found)


def sources_hash(root: Path = _APP) -> str:
    """A short hash of all sources that a kernel can see, of numba's version and of Python's."""
    digest = hashlib.sha256(f"{importlib.metadata.version('numba')} {platform.python_version()}".encode())
    for path in kernel_sources(root):
        digest.update(str(path.relative_to(root)).encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]


def choose_cache_folder(name: str) -> Path | None:
    """A writable folder for compiled kernels: the user's, or else one that is removed at exit; None: none."""
    folder = Path(platformdirs.user_cache_dir("stridescope", appauthor=False)) / "kernels" / name
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
        os.utime(folder)
        forget_old(folder.parent)
    except OSError:
        try:
            folder = Path(tempfile.mkdtemp(prefix="stridescope-kernels-"))
        except OSError:
            _log.warning("no folder can be written, not even a temporary one: each start compiles anew")
            return None
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def forget_old(kernels: Path) -> None:
    """Remove the folders in ``kernels`` that no start has used for two months."""
    used_before_s = time.time() - FORGOTTEN_S
    for folder in kernels.iterdir():
        with contextlib.suppress(OSError):  # another start may be removing it
            if folder.stat().st_mtime < used_before_s:
                shutil.rmtree(folder)


#: Names the kernels of this program: the same name, the same numbers.
KERNELS = sources_hash()
FOLDER = choose_cache_folder(KERNELS)
if FOLDER is not None:
    os.environ["NUMBA_CACHE_DIR"] = str(FOLDER)

import numba  # noqa: E402  (the folder has to be known first)
from llvmlite.binding import ffi as llvm  # noqa: E402
from numba.core import caching  # noqa: E402
from numba.extending import register_jitable  # noqa: E402

# Left out while compiling, a tenth of it: a record's type spelled out in full at every pass, and numba's
# own note of every call of LLVM, for each compilation that is under way.
numba.types.Record.__repr__ = numba.types.Type.__repr__  # type: ignore[method-assign]
with contextlib.suppress(AttributeError):
    llvm.lib._lock._cblist.clear()


class Shelf(caching.IndexDataCacheFile):
    """A kernel's files. What a power cut spoilt is compiled again and replaced; a full disk keeps none."""

    def _load_index(self) -> dict[Any, str]:
        with contextlib.suppress(Exception):  # a torn pickle raises anything
            return dict(super()._load_index())  # type: ignore[no-untyped-call]
        return {}

    def load(self, key: object) -> object:
        """What was kept, or None."""
        with contextlib.suppress(Exception):
            return super().load(key)  # type: ignore[no-untyped-call]
        return None

    def save(self, key: object, data: object) -> None:
        """Keep it, where there is room."""
        with contextlib.suppress(OSError):
            super().save(key, data)  # type: ignore[no-untyped-call]


caching.IndexDataCacheFile = Shelf  # type: ignore[misc]

#: No kernel is called from C; numba's types do not know the option.
_OPTIONS: Any = {"no_cfunc_wrapper": True}


def kernel(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """Compile ``function`` on its first call, cached, without the interpreter lock."""
    compiled: Callable[_P, _R] = numba.njit(cache=FOLDER is not None, nogil=True, **_OPTIONS)(function)
    return compiled


def part(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """Compile ``function`` into the kernels that call it, in half the time of a kernel; none of its own.

    Python can still call it, as Python, slowly: that is for tests.
    """
    register_jitable(**_OPTIONS, no_cpython_wrapper=True)(function)
    return function
