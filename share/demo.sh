#!/usr/bin/env bash
# The whole tour in one command: installs missing packages, builds, simulates a survey of the canal, makes its map
# and reports how far both are from the truth. Results: out/demo/sim (survey and truth) and out/demo/map (products).
# Usage: share/demo.sh [--duration SECONDS]   (default 90; at least a lap's half is needed for a good picture)
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
duration=90
if [ "${1:-}" = "--duration" ]; then duration=$2; shift 2; fi

"$root/share/build.sh" release simulate-survey seabed-sky-map seabed-sky-eval
cd "$root"
bin=build/release/bin
sim=out/demo/sim
map=out/demo/map

stamp="$duration $(cksum share/scenes/canal.ini | cut -d' ' -f1) $(cksum $bin/simulate-survey | cut -d' ' -f1)"
if [ "$(cat "$sim/.stamp" 2>/dev/null)" = "$stamp" ]; then
  echo "== Survey: $sim is up to date"
else
  echo "== Survey: simulating $duration s into $sim"
  $bin/simulate-survey --scene share/scenes/canal.ini --experiment 1 --duration "$duration" --output "$sim"
  echo "$stamp" >"$sim/.stamp"
fi

echo "== Map: $sim/survey.rawlog into $map"
$bin/seabed-sky-map "$sim/survey.rawlog" --config "$sim/survey.ini" --output "$map"

echo "== Evaluation against the simulated truth"
$bin/seabed-sky-eval truth "$map" "$sim/truth" --json "$map/truth.json"

echo "== Control points: retro-reflective targets picked in the map, against their surveyed places"
points=$sim/truth/control_points.csv
if $bin/seabed-sky-eval pick "$map" --points "$points" --truth "$sim/truth" --output "$map/picks.csv"; then
  $bin/seabed-sky-eval control "$map" --points "$points" --picks "$map/picks.csv" --json "$map/control.json"
else
  echo "Fewer than three targets were seen in this part of the survey; a longer one sees more (--duration)."
fi

echo "== Done. Open $map/report.html, or $map/map.3Dscene with SceneViewer3D."
