#!/usr/bin/env bash
# Installs missing packages and builds a preset (release by default) into build/<preset>.
# Usage: share/build.sh [release|debug|asan] [ninja arguments or targets …]
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
preset=${1:-release}
[ $# -gt 0 ] && shift

"$root/share/install-packages.sh"
cd "$root"
echo "== Build: preset $preset into build/$preset"
log=$(cmake --preset "$preset" 2>&1) || { echo "$log" >&2; exit 1; }
cmake --build "build/$preset" -- "$@"
