# bash completion of the tools fsr-*: options as --help lists them, and files of the kind that the option before them takes.
_fsr_pressure_map() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} pattern='@(bag|h5|yaml|yml|csv|stl|ply|obj)' help values
  compopt -o filenames 2>/dev/null
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$("$1" --help 2>/dev/null | grep -oE '^  --[a-z0-9-]+')" -- "$word")
    return
  fi
  if [[ $before == --* ]]; then
    # Names that the help lists, as in "--model NAME  linear, grnn, forest, monotone; default grnn".
    help=$("$1" --help 2>/dev/null | grep -E "^  $before +(NAME|ID|FORMAT) ")
    values=$(sed -E 's/^ +--[a-z-]+ +[A-Z]+ +//; s/;.*//; s/\([^)]*\)//g; s/^[^:]*://; s/,| or / /g' <<<"$help")
    mapfile -t COMPREPLY < <(compgen -W "$values" -- "$word")
    [ ${#COMPREPLY[@]} -eq 0 ] || return
    case $before in
      --check | --calibration | --first) pattern=h5 ;;
      --simulation | --plan | --gap | --rig | --surface) pattern='@(yaml|yml)' ;;
      --drive) pattern=bag ;;
    esac
  fi
  local extglob
  extglob=$(shopt -p extglob)
  shopt -s extglob
  mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -X "!*.$pattern" -- "$word")
  eval "$extglob"
}
