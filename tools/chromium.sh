#!/bin/sh
# Sees to it that the tests can drive a Chromium: the one that is there; Debian's, where we are root; or one line, exit 2.
set -eu
cd "$(dirname "$0")/.."

[ "${CHROMIUM:-}" = skip ] && exit 0
if [ -n "${CHROMIUM_PATH:-}" ] && ! [ -x "$CHROMIUM_PATH" ]; then
    echo "test: CHROMIUM_PATH=$CHROMIUM_PATH: expected a program that can be run" >&2
    exit 2
fi

found() {
    [ -n "${CHROMIUM_PATH:-}" ] || command -v chromium || command -v chromium-browser || command -v google-chrome ||
        [ -x "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome" ] ||
        [ -x /Applications/Chromium.app/Contents/MacOS/Chromium ]
}

missing=
found >/dev/null || missing=chromium
# Playwright's driver needs a library that a bare Debian lacks.
.venv/bin/python -m playwright --version >/dev/null 2>&1 || missing="$missing libatomic1"
[ -z "$missing" ] && exit 0

if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    echo "test: installing $missing with apt-get"
    export DEBIAN_FRONTEND=noninteractive
    # shellcheck disable=SC2086 # a list of packages
    if said=$(apt-get update -qq 2>&1 && apt-get install -y -qq --no-install-recommends $missing 2>&1); then
        exit 0
    fi
    echo "test: apt-get install $missing: $(echo "$said" | tail -n 1)" >&2
    exit 2
fi
echo "test: the browser tests need $missing: install it (Debian: apt-get install $missing; macOS: brew install --cask" \
    "chromium), or set CHROMIUM_PATH, or run the rest with CHROMIUM=skip" >&2
exit 2
