# For the bash scripts beside it: the environment of the built package, from where measurement/programs.py looks for it, too,
# with that place as $devel. Takes the script's arguments away.
#   . "$(dirname "$0")/built_space.bash"
devel=${UAV_LANDING_DEVEL_DIR:-}
if [ -z "$devel" ]; then
  IFS=: read -ra spaces <<<"${CMAKE_PREFIX_PATH:-}"
  for space in "${spaces[@]}" "$(dirname "${BASH_SOURCE[0]}")/../build/devel"; do
    [ -n "$space" ] || continue  # as where the variable ends in a colon
    devel=$(realpath -m "$space")
    [ ! -d "$devel/lib/uav_landing" ] || break
  done
fi
if [ ! -d "$devel/lib/uav_landing" ]; then
  echo "$(basename "$0"): build first: scripts/build, or catkin_make and . devel/setup.bash in a catkin workspace" >&2
  exit 1
fi
export PATH=/usr/bin:$PATH
set +u --
. "$devel/setup.bash"
set -u
