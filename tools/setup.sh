#!/bin/sh
# Makes .venv with the app and its development tools from the lock. A second call with nothing changed is instant.
set -eu
cd "$(dirname "$0")/.."

fits='import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 15))'

choose_python() {
    for python in ${PYTHON:-python3 python3.14 python3.13 python3.12 python3.11}; do
        if "$python" -c "$fits" 2>/dev/null; then
            echo "$python"
            return
        fi
    done
    python=${PYTHON:-python3}
    came=$("$python" --version 2>/dev/null || echo "not there")
    echo "setup: $python is $came: expected Python 3.11 to 3.14 (make setup PYTHON=/path/to/python3.12)" >&2
    exit 2
}

# A .venv made elsewhere and moved here, or left by a Python since removed, is of no use.
usable() {
    .venv/bin/python -c "$fits" 2>/dev/null && grep -qF "$(pwd -P)/.venv/bin/" .venv/bin/pip &&
        { [ -z "${PYTHON:-}" ] || [ "$("$PYTHON" --version 2>/dev/null)" = "$(.venv/bin/python --version)" ]; }
}

pip() {
    .venv/bin/python -m pip --disable-pip-version-check --no-input install --quiet "$@"
}

wanted=$(cat requirements.txt pyproject.toml | cksum)
usable || rm -f .venv/.ready
[ "$(cat .venv/.ready 2>/dev/null)" = "$wanted" ] && exit 0

if usable; then
    echo "setup: bringing .venv up to date"
else
    python=$(choose_python)
    echo "setup: installing into .venv (about a minute, this once)"
    if ! said=$("$python" -m venv --clear .venv 2>&1); then
        echo "setup: $python cannot make .venv: expected venv with pip (Debian: apt-get install python3-venv):" \
            "$(echo "$said" | tail -n 1)" >&2
        exit 2
    fi
fi
rm -f .venv/.ready
pip --require-hashes --only-binary :all: --requirement requirements.txt
PYTHONWARNINGS=ignore pip --no-deps --no-build-isolation --editable .
echo "$wanted" >.venv/.ready
