# Completion of the ss-tools for bash: options as --help lists them, the shipped scenes, the columns
# of a file that the line names, files.

_stickslip_options()    # TOOL: "-c", "--column=" ... a line each
{
    "$1" --help 2> /dev/null | sed -n -e '/^ *-/!d' -e 's/^ *//' -e 's/   *[^ -].*//p' -e '/^-/p' |
        grep -oE '(^| |,)(-[a-zA-Z]|--[a-z0-9-]+=?)' | tr -d ' ,' | sort -u
}

_stickslip_scenes()
{
    ss-sim --list 2> /dev/null | sed -n -e '/^$/q' -e 's/[[:space:]].*//p'
}

_stickslip_columns()    # of the last file among the words
{
    local word file=
    for word in "${COMP_WORDS[@]:1}"; do
        word=${word/#\~/$HOME}
        if [[ -f ${word%%:/*} ]]; then file=$word; fi
    done
    [[ -z $file ]] || ss-cat "$file" 2> /dev/null |
        sed -n '/^# columns:/{s/^# columns: *//;s/t\/s *//;s/\/[^ ]*//g;p;q;}' | tr ' ' '\n'
}

_stickslip()
{
    local tool=$1 word=$2 before=$3
    if [[ $word == = ]]; then word=; fi
    if [[ $before == = ]]; then before=${COMP_WORDS[COMP_CWORD - 2]}; fi
    COMPREPLY=()
    case $before in
    -c|--column|-t|--time|--columns|--xy)
        mapfile -t COMPREPLY < <(compgen -W "$(_stickslip_columns)" -- "$word")
        return ;;
    esac
    if [[ $tool == ss-sim && ( $before == --method || $before == -m ) ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(ss-sim --list | sed -n 's/^methods: //p')" -- "$word")
        return
    fi
    if [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_stickslip_options "$tool")" -- "$word")
        if [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *= ]]; then compopt -o nospace 2> /dev/null; fi
        return
    fi
    case $tool in
    ss-sim|ss-trade|ss-rank|ss-sweep)
        mapfile -t COMPREPLY < <(compgen -W "$(_stickslip_scenes)" -- "$word") ;;
    esac
    mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$word")
    compopt -o filenames 2> /dev/null
}

complete -F _stickslip ss-cat ss-contour ss-features ss-morlet ss-noise ss-plot ss-rank ss-signal ss-sim \
    ss-sweep ss-trade
