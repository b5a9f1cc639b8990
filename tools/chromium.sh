#!/bin/sh
# Sees to it that the tests find a Chromium: the one that is there, or Debian's where we are root, or one line and exit 2.
set -eu

[ "${CHROMIUM:-}" = skip ] && exit 0
if [ -n "${CHROMIUM_PATH:-}" ]; then
    [ -x "$CHROMIUM_PATH" ] && exit 0
    echo "test: CHROMIUM_PATH=$CHROMIUM_PATH: expected a program that can be run" >&2
    exit 2
fi
for name in chromium chromium-browser google-chrome; do
    command -v "$name" >/dev/null && exit 0
done
for program in "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome" \
    /Applications/Chromium.app/Contents/MacOS/Chromium; do
    [ -x "$program" ] && exit 0
done

if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    echo "test: installing chromium with apt-get"
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends chromium >/dev/null
    exit 0
fi
echo "test: no Chromium found: install it (Debian: apt-get install chromium; macOS: brew install --cask chromium)," \
    "set CHROMIUM_PATH, or run the rest with CHROMIUM=skip" >&2
exit 2
