# Tab completion of options, for bash: . scripts/completion.bash (after . build/devel/setup.bash)
#   rosrun uav_landing process_bag --in<Tab>        scripts/calibrate --sq<Tab>
# The options are those that the program's own --help lists; other words complete as file names.

_uav_landing_options() {  # command...: the long options in its help
  "$@" --help 2>/dev/null </dev/null | grep -oE -e '(^|[ ,[])--[a-z][a-z0-9-]*' | grep -oE -e '--.*' | sort -u
}

_uav_landing_offer() {  # word command...
  local word=$1
  shift
  COMPREPLY=()
  case $word in
    -*) mapfile -t COMPREPLY < <(compgen -W "$(_uav_landing_options "$@")" -- "$word") ;;
  esac
}

_uav_landing_rosrun() {
  if [[ ${COMP_WORDS[1]} == uav_landing && $COMP_CWORD -ge 3 ]]; then
    _uav_landing_offer "${COMP_WORDS[COMP_CWORD]}" rosrun uav_landing "${COMP_WORDS[2]}"
  elif declare -F _roscomplete_exe >/dev/null; then
    _roscomplete_exe
  fi
}

_uav_landing_script() {
  _uav_landing_offer "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[0]}"
}

complete -o default -F _uav_landing_rosrun rosrun
for _uav_landing_file in "${BASH_SOURCE[0]%/*}"/*; do
  if [[ -f $_uav_landing_file && -x $_uav_landing_file ]]; then
    complete -o default -F _uav_landing_script "scripts/${_uav_landing_file##*/}"
  fi
done
unset _uav_landing_file
