#!/bin/sh
# Makes .venv with the app and its development tools from the lock. A second call with nothing changed is instant.
set -eu
cd "$(dirname "$0")/.."

fits='import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 15))'

# What .venv was made from, and where: a moved checkout or another Python needs a new one.
state() {
    { cat requirements.txt pyproject.toml tools/setup.sh; pwd; .venv/bin/python --version; } 2>/dev/null | cksum
}

choose_python() {
    for python in ${PYTHON:-python3 python3.14 python3.13 python3.12 python3.11}; do
        if "$python" -c "$fits" 2>/dev/null; then
            echo "$python"
            return
        fi
    done
    echo "setup: ${PYTHON:-python3} is $("${PYTHON:-python3}" --version 2>/dev/null || echo "not there"):" \
        "expected Python 3.11 to 3.14 (make setup PYTHON=/path/to/python3.12)" >&2
    exit 2
}

[ "$(cat .venv/.ready 2>/dev/null)" = "$(state)" ] && exit 0

python=$(choose_python)
echo "setup: installing into .venv (once; about a minute)"
if ! said=$("$python" -m venv --clear .venv 2>&1); then
    echo "setup: $python -m venv: $(echo "$said" | tail -n 1): expected a Python with venv (Debian: python3-venv)" >&2
    exit 2
fi
pip() { .venv/bin/python -m pip --disable-pip-version-check --no-input install --quiet "$@"; }
pip --require-hashes --only-binary :all: --requirement requirements.txt
pip --no-deps --no-build-isolation --editable .
state >.venv/.ready
