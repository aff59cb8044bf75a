#!/usr/bin/env bash
# Which physics hurts which stage: simulates the same survey once with everything and once with each effect switched
# off, maps every one and prints the errors against the truth, one line a run.
# Usage: share/ablation.sh [--scene INI] [--experiment N] [--duration SECONDS] [--output DIR]
set -euo pipefail
export LC_ALL=C  # numbers with a decimal point
root=$(cd "$(dirname "$0")/.." && pwd)
bin="$root/build/release/bin"
scene="$root/share/scenes/canal.ini"
experiment=1
duration=60
output="$root/out/ablation"
while [ $# -gt 0 ]; do
  case "$1" in
    --scene) scene=$2 ;;
    --experiment) experiment=$2 ;;
    --duration) duration=$2 ;;
    --output) output=$2 ;;
    *) echo "ablation.sh: unknown option '$1'" >&2; exit 2 ;;
  esac
  shift 2
done
"$root/share/build.sh" release simulate-survey seabed-sky-map seabed-sky-eval

# Name of the run, then the settings that switch the effect off.
runs=(
  "all-effects"
  "calm-water waves.enabled=false"
  "perfect-imu imu.noise=false"
  "no-lidar-noise lidar.noise=false lidar.bias=false"
  "no-mixed-pixels lidar.mixed_pixels=false"
  "no-water-returns lidar.water_returns=false lidar.water_ghosts=false"
  "no-own-vessel lidar.own_vessel=false"
  "no-speckle sonar.horizontal.speckle=false sonar.vertical.speckle=false"
  "no-sonar-noise sonar.horizontal.noise=false sonar.vertical.noise=false"
  "no-beam-pattern sonar.horizontal.beam_pattern=false sonar.vertical.beam_pattern=false"
  "sharp-aperture sonar.horizontal.elevation_pattern=rectangle sonar.vertical.elevation_pattern=rectangle"
  "no-multipath sonar.horizontal.multipath=false sonar.vertical.multipath=false"
  "no-texture sonar.horizontal.texture=false sonar.vertical.texture=false"
  "no-cross-talk sonar.horizontal.cross_talk=false sonar.vertical.cross_talk=false"
  "no-banding-streaks-haze sonar.horizontal.banding=false sonar.horizontal.streaks=false sonar.vertical.centre_haze=false"
)

# value FILE PATH…: a number of a JSON file; the eval program writes one key a line, indented by nesting.
value() {
  awk -v want="$2" '
    { match($0, /^ */); depth = int(RLENGTH / 2)
      if (match($0, /"[^"]+" *:/)) { key = substr($0, RSTART + 1); sub(/".*/, "", key); path[depth] = key
        full = path[1]; for (i = 2; i <= depth; ++i) full = full "." path[i]
        if (full == want) { v = $0; sub(/^[^:]*: */, "", v); sub(/,$/, "", v); print v; exit } } }' "$1"
}

printf '%-26s %14s %14s %14s %14s %14s\n' run "ATE [m]" "lidar med [m]" "stereo med [m]" "seabed bias" "seabed RMSE"
for run in "${runs[@]}"; do
  read -r -a words <<<"$run"
  name=${words[0]}
  settings=()
  for setting in "${words[@]:1}"; do settings+=(--set "$setting"); done
  dir="$output/$name"
  mkdir -p "$dir"
  if ! { "$bin/simulate-survey" --scene "$scene" --experiment "$experiment" --duration "$duration" \
           --output "$dir/sim" "${settings[@]}" &&
         "$bin/seabed-sky-map" "$dir/sim/survey.rawlog" --config "$dir/sim/survey.ini" --output "$dir/map" &&
         "$bin/seabed-sky-eval" truth "$dir/map" "$dir/sim/truth" --json "$dir/truth.json"; } >"$dir/log.txt" 2>&1; then
    printf '%-26s failed, see %s\n' "$name" "$dir/log.txt"
    continue
  fi
  printf '%-26s' "$name"
  for key in trajectory.ate_m.rmse layers.lidar.distance_m.median layers.stereo.distance_m.median seabed.bias_m \
             seabed.rmse_m; do
    number=$(value "$dir/truth.json" "$key")
    case "$number" in "" | null) printf ' %14s' - ;; *) printf ' %14.4f' "$number" ;; esac
  done
  printf '\n'
  rm -f "$dir/sim/survey.rawlog"
done
echo "Logs and reports: $output"
