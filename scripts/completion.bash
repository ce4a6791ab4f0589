# Tab completion of options, for bash: . scripts/completion.bash (after . build/devel/setup.bash)
#   rosrun uav_landing process_bag --in<Tab>        scripts/calibrate --sq<Tab>
# The options are those that the program's own --help lists; other words complete as file names, and what comes before the
# program's name as rosrun's own completion has it.

_uav_landing_scripts=$(cd "${BASH_SOURCE[0]%/*}" && pwd)

# Long options of a help text (stdin): those that its list of options begins a line with; without a list, as in the comment
# of a bash script, all that are named.
_uav_landing_listed() {
  local help
  help=$(cat)
  if grep -qiE '^option(s|al arguments):' <<<"$help"; then
    grep -E '^ {1,4}-' <<<"$help" | sed -E 's/^( *(-[A-Za-z]( [^ ,]+)?, ?)?--[a-z][a-z0-9-]*).*/\1/'
  else
    printf '%s\n' "$help"
  fi | grep -oE -e '(^|[ ,[])--[a-z][a-z0-9-]*' | grep -oE -e '--.*' | sort -u
}

# command... -- word...: the long options that fit behind the words; a subcommand among them has its own.
_uav_landing_options() {
  local command=() help own
  while [[ $1 != -- ]]; do
    command+=("$1")
    shift
  done
  shift
  help=$("${command[@]}" --help 2>/dev/null </dev/null)
  # Names of subcommands stand in the usage with bars between; no other word goes to a program, which might begin to work.
  if [[ ${1:-} =~ ^[a-z_]+$ ]] && grep -qE "^usage:.*[ |]$1\|.*|^usage:.*\|$1( |$)" <<<"$help"; then
    own=$("${command[@]}" "$1" --help 2>/dev/null </dev/null)
  fi
  _uav_landing_listed <<<"${own:-$help}"
}

_uav_landing_offer() {  # index of the first word behind the program, command...
  local behind=$1 word=${COMP_WORDS[COMP_CWORD]}
  shift
  COMPREPLY=()
  case $word in
    -*)
      mapfile -t COMPREPLY < <(
        compgen -W "$(_uav_landing_options "$@" -- "${COMP_WORDS[@]:behind:COMP_CWORD-behind}")" -- "$word")
      ;;
  esac
}

_uav_landing_rosrun() {
  if [[ ${COMP_WORDS[1]} == uav_landing && $COMP_CWORD -ge 3 ]]; then
    _uav_landing_offer 3 rosrun uav_landing "${COMP_WORDS[2]}"
  elif declare -F _roscomplete_exe >/dev/null; then
    _roscomplete_exe
  fi
}

_uav_landing_script() {
  # Another folder's program of the same name is not run.
  if [[ ${COMP_WORDS[0]} -ef $_uav_landing_scripts/${COMP_WORDS[0]##*/} ]]; then
    _uav_landing_offer 1 "${COMP_WORDS[0]}"
  else
    COMPREPLY=()
  fi
}

# rosrun's own completion is loaded on demand only as long as there is none.
_uav_landing_load_rosrun() {
  local file
  if ! declare -F _roscomplete_exe >/dev/null && declare -F _completion_loader >/dev/null; then
    _completion_loader rosrun
  fi
  for file in /usr/share/bash-completion/completions/{rosrun,rosbash}; do
    if ! declare -F _roscomplete_exe >/dev/null && [[ -r $file ]]; then
      . "$file"
    fi
  done
}

_uav_landing_register() {  # the scripts' folder, as it may be written in front of them
  local file folder
  complete -o default -F _uav_landing_rosrun rosrun
  for file in "$_uav_landing_scripts"/*; do
    if [[ -f $file && -x $file ]]; then
      for folder in "$@"; do
        complete -o default -F _uav_landing_script "$folder/${file##*/}"
      done
    fi
  done
}

_uav_landing_load_rosrun
_uav_landing_register scripts ./scripts "${BASH_SOURCE[0]%/*}" "$_uav_landing_scripts"
unset -f _uav_landing_load_rosrun _uav_landing_register
