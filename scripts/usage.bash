# For the bash scripts beside it: with -h or --help, print the comment at the top of the script and leave.
#   . "$(dirname "$0")/usage.bash"
case ${1:-} in
  -h | --help)
    sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"
    exit 0
    ;;
esac
