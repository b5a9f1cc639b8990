"""Where compiled kernels are kept, and when they are thrown away."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
import tempfile
import textwrap
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from app import compiled

APP = Path(compiled.__file__).parent

RUN_A_KERNEL = """
import os
from pathlib import Path
from app import compiled, rotation
turn = rotation.from_yaw(0.0)
assert turn == (1.0, 0.0, 0.0, 0.0) and rotation.from_yaw.signatures
print(os.environ["NUMBA_CACHE_DIR"])
print(len(list(Path(os.environ["NUMBA_CACHE_DIR"]).rglob("*.nbc"))))
"""


@pytest.fixture
def house(tmp_path: Path) -> Path:
    """A small app: step → turn (a called kernel) → words (a constant both froze); page sees them all."""
    sources = {
        "compiled.py": "def kernel(function): return function",
        "words.py": "GRAVITY = 9.8",
        "estimator/turn.py": """
            from app.compiled import kernel
            from app import words
            @kernel
            def turn(x): return x * words.GRAVITY""",
        "estimator/step.py": """
            from app.compiled import kernel
            from app.estimator.turn import turn
            @kernel
            def step(x): return turn(x)""",
        "page.py": "from app.estimator import step",
    }
    for name, source in sources.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(textwrap.dedent(source), "utf-8")
    return tmp_path


@pytest.mark.parametrize("name", ["compiled.py", "words.py", "estimator/turn.py", "estimator/step.py"])
def test_hash_follows_every_file_a_kernel_sees(house: Path, name: str) -> None:
    before = compiled.sources_hash(house)
    with (house / name).open("a", encoding="utf-8") as file:
        file.write("\n# changed\n")
    assert compiled.sources_hash(house) != before


def test_hash_leaves_alone_what_no_kernel_sees(house: Path) -> None:
    before = compiled.sources_hash(house)
    (house / "page.py").write_text("COLOUR = 'blue'", "utf-8")
    assert compiled.sources_hash(house) == before


def test_what_other_versions_left_long_ago_is_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    old, recent = compiled.choose_cache_folder("old"), compiled.choose_cache_folder("recent")
    assert old is not None
    assert recent is not None
    (old / "a.nbc").write_bytes(b"machine code")
    long_ago_s = time.time() - 1.1 * compiled.FORGOTTEN_S
    os.utime(old, (long_ago_s, long_ago_s))
    used = compiled.choose_cache_folder("used")
    assert used is not None
    assert sorted(used.parent.iterdir()) == [recent, used]
    os.utime(used, (long_ago_s, long_ago_s))
    assert compiled.choose_cache_folder("used") == used
    assert used.is_dir(), "a start is a use"


def run_a_kernel(home: Path, temporary: Path, script: str = RUN_A_KERNEL) -> tuple[Path, int]:
    """A kernel run in a process of its own: its cache folder and how many kernels lay in it."""
    temporary.mkdir(exist_ok=True)
    kept = {k: v for k, v in os.environ.items() if k not in {"XDG_CACHE_HOME", "NUMBA_CACHE_DIR"}}
    environment = kept | {"HOME": str(home), "TMPDIR": str(temporary)}
    command = [sys.executable, "-c", script]
    ran = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=100, check=False)
    assert ran.returncode == 0, ran.stderr
    folder, kernels = ran.stdout.split("\n")[:2]
    return Path(folder), int(kernels)


def run_among_damaged(home: Path, temporary: Path, pattern: str) -> list[int]:
    """Files' lengths after a kernel ran twice, between the runs those of one kind were cut short."""
    folder, _ = run_a_kernel(home, temporary)
    for path in folder.rglob(pattern):
        path.write_bytes(path.read_bytes()[:50])
    run_a_kernel(home, temporary)
    return [path.stat().st_size for path in folder.rglob(pattern)]


@pytest.mark.parametrize("pattern", ["*.nbi", "*.nbc"])
def test_kernels_that_a_power_cut_spoilt_are_made_anew(tmp_path: Path, pattern: str) -> None:
    (tmp_path / "home").mkdir()
    sizes = run_among_damaged(tmp_path / "home", tmp_path / "tmp", pattern)
    assert sizes
    assert min(sizes) > 50


@pytest.mark.skipif(sys.platform == "darwin", reason="a full folder by a limit on files' sizes: Linux")
def test_a_full_disk_keeps_no_kernels(tmp_path: Path) -> None:
    (tmp_path / "home").mkdir()
    limited = "import resource; "
    limited += "resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))\n"
    _, kernels = run_a_kernel(tmp_path / "home", tmp_path / "tmp", limited + RUN_A_KERNEL)
    assert kernels == 0


def test_kernels_are_kept_in_the_users_cache_folder(tmp_path: Path) -> None:
    home = tmp_path / "home"
    home.mkdir()
    folder, kernels = run_a_kernel(home, tmp_path / "tmp")
    assert home in folder.parents
    assert folder.name == compiled.sources_hash()
    assert kernels > 0


def test_a_home_that_cannot_be_written_still_runs_and_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").touch()  # no folder can be made below a file, not even by root
    folder, kernels = run_a_kernel(tmp_path / "file" / "home", tmp_path / "tmp")
    assert folder.parent == tmp_path / "tmp"
    assert kernels > 0
    assert not folder.exists()


def test_numba_reads_the_folder_chosen_here() -> None:
    numba = sys.modules["numba"]
    assert os.environ["NUMBA_CACHE_DIR"] == numba.config.CACHE_DIR


def test_python_calls_no_part() -> None:
    """A part that Python calls runs as Python: right, and a hundred times slower."""
    trees = {path: ast.parse(path.read_text("utf-8")) for path in APP.rglob("*.py")}
    parts = {(module_of(path), name) for path, tree in trees.items() for name in marked(tree, {"part"})}
    assert parts
    called = []
    for path, tree in trees.items():
        here = {name for module, name in parts & known_to(path, tree)}
        called += [f"{path.name}:{n.lineno}: {n.id}" for n in names_in_python(tree) if n.id in here]
    assert called == []


def module_of(path: Path) -> str:
    return ".".join(path.relative_to(APP.parent).with_suffix("").parts)


def marked(tree: ast.Module, marks: set[str]) -> set[str]:
    functions = [node for node in tree.body if isinstance(node, ast.FunctionDef)]
    return {f.name for f in functions for d in f.decorator_list if isinstance(d, ast.Name) and d.id in marks}


def known_to(path: Path, tree: ast.Module) -> set[tuple[str, str]]:
    """Names with the module they are from: its own and the imported."""
    imports = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
    imported = {(str(node.module), alias.name) for node in imports for alias in node.names}
    return imported | {(module_of(path), name) for name in marked(tree, {"part"})}


def names_in_python(tree: ast.Module) -> Iterator[ast.Name]:
    """Names used outside kernels and parts."""
    compiled_here = marked(tree, {"part", "kernel"})
    for node in tree.body:
        if not (isinstance(node, ast.FunctionDef) and node.name in compiled_here):
            yield from (name for name in ast.walk(node) if isinstance(name, ast.Name))


def test_where_nothing_can_be_written_kernels_run_and_are_not_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """A machine whose every folder is read-only: a line, and a slow start."""

    def none(*_: object, **__: object) -> str:
        raise FileNotFoundError(2, "No usable temporary directory found")

    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file" / "cache"))
    monkeypatch.setattr(tempfile, "mkdtemp", none)
    assert compiled.choose_cache_folder("name") is None
    assert [record.getMessage() for record in caplog.records] == [
        "no folder can be written, not even a temporary one: each start compiles anew"
    ]
    monkeypatch.setattr(compiled, "FOLDER", None)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "file" / "kernels"))

    def next_one(x: int) -> int:
        return x + 1

    assert compiled.kernel(next_one)(1) == 2
