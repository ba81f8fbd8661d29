# Completion of the ss-tools for bash.  Nothing is listed here: options and what they take are read
# from --help, values from what the tool says of a wrong one, scenes and keys from ss-sim --list,
# columns from a file that the line names.

_stickslip_options()    # TOOL: a line each, "--column NAME|N", "-c NAME|N", "--quiet"
{
    local line word short
    local -a words
    local -A takes=()
    while read -r line; do
        [[ $line == -* ]] || continue
        short=
        read -ra words <<< "${line//[;()]/ }"
        for word in "${words[@]}"; do
            word=${word%[,:]}
            case $word in
            -[a-zA-Z])   short=$word takes[$word]=${takes[$word]-} ;;
            --[a-z]*=*)  takes[${word%%=*}]=${word#*=}
                         [[ -z $short ]] || takes[$short]=${word#*=}
                         short= ;;
            --[a-z]*)    takes[$word]=${takes[$word]-} short= ;;
            esac
        done
    done < <("$1" --help 2> /dev/null)
    for word in "${!takes[@]}"; do echo "$word ${takes[$word]}"; done | sort
}

_stickslip_ask()        # TOOL WRONG ...: the right values
{
    "$@" 2>&1 < /dev/null |
        sed -n -e 's/ ([^)]*)//g' -e 's/.* is none of //p' | tr -d ' ' | tr , '\n'
}

_stickslip_scenes()
{
    ss-sim --list 2> /dev/null | sed -n -e '/^$/q' -e 's/[[:space:]].*//p'
}

_stickslip_keys()       # WANTED WORD ...: "key=" of the scenes among the words, else of those shipped
{
    local wanted=$1 word shipped
    local -a scenes=()
    shift
    shipped=$(_stickslip_scenes)
    for word; do
        if [[ -f $word || $'\n'$shipped$'\n' == *$'\n'$word$'\n'* ]]; then scenes+=("$word"); fi
    done
    for word in "${scenes[@]:-$shipped}"; do
        for word in $word; do ss-sim --list "$word" 2> /dev/null; done
    done | sed -n "s/^\([a-z0-9_]*\) = $wanted.*/\1=/p" | sort -u
}

_stickslip_words()      # KEY: what it may be in a shipped scene that has it, if that is no number
{
    local scene
    for scene in $(_stickslip_scenes); do
        ss-sim --list "--set=$1=?" -- "$scene" 2>&1 < /dev/null
    done | sed -n 's/.* must be one of //p' | tr -d ' ' | tr , '\n' | sort -u
}

_stickslip_columns()    # WORD ...: of the last file among them
{
    local word file= pick='/^[^#]/q;/^# columns:/{s/^# columns: *//;s/t\/s *//;s/\/[^ ]*//g;p;q;}'
    for word; do
        word=${word/#\~/$HOME}
        if [[ -f ${word%%:/*} ]]; then file=$word; fi
    done
    if [[ -z $file ]]; then return; fi
    { sed -n "$pick" < "$file" | grep . || ss-cat -- "$file" | sed -n "$pick"; } 2> /dev/null | tr ' ' '\n'
}

_stickslip()
{
    local tool=$1 seen=${2#=} line=${COMP_LINE:0:COMP_POINT} current option= takes= front= list=
    local -a words options known=()
    current=${line##*[[:space:]]}
    read -ra words <<< "${line%"$current"}"
    mapfile -t options < <(_stickslip_options "$tool")
    COMPREPLY=()

    # What is to be completed: the value of an option, with $front before it on the line; an option; or
    # an argument, which stands in the first line of --help.
    case $current in
    --*=*) option=${current%%=*} front=${current%%=*}= ;;
    *)     if [[ ${#words[@]} -gt 1 && ${words[-1]} == -* ]]; then option=${words[-1]}; fi ;;
    esac
    for line in "${options[@]}"; do
        if [[ -n $option && ${line%% *} == "$option" ]]; then takes=${line#* }; fi
    done
    case $takes in *LIST*|X,Y*)
        if [[ $current == *,* ]]; then front=${current%,*},; fi
        compopt -o nospace 2> /dev/null ;;
    esac
    case $takes in
    '')
        if [[ -n $front ]]; then return; fi
        if [[ $current == -* ]]; then
            for line in "${options[@]}"; do
                if [[ $line == --*' '?* ]]; then list+=" ${line%% *}="; else list+=" ${line%% *}"; fi
            done
        else
            line=$("$tool" --help 2> /dev/null | sed q)
            case $line in *SCENE*) list=$(_stickslip_scenes) ;; esac
            case $line in *KIND*) list=$(_stickslip_ask "$tool" '?') ;; *) takes=FILE ;; esac
        fi ;;
    FILE)              list= ;;
    'NAME|N'|X,Y*)     list=$(_stickslip_columns "${words[@]:1}") ;;
    KEY=VALUE|K=A:B:N)
        if [[ ${current#"$front"} == *=* ]]; then
            option=${current#"$front"}
            option=${option%%=*}
            list=$(_stickslip_words "$option")
            front=$front$option=
        else
            list=$(_stickslip_keys "$([[ $takes == K=* ]] && echo '[-0-9.]')" "${words[@]:1}")
        fi ;;
    *)                 # the second wrong option keeps the tool from working
        if [[ $option == --* ]]; then option+='='; fi
        list=$(_stickslip_ask "$tool" "$option?" '--?') ;;
    esac

    # Not by compgen -W, which would run a name of a file's column that is $(a command).
    read -r -d '' -a known <<< "$list" || :
    for line in ${known[@]+"${known[@]}"}; do
        if [[ $line == "${current#"$front"}"* ]]; then COMPREPLY+=("$(printf %q "$line")"); fi
    done
    if [[ $takes == *FILE* ]]; then
        mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "${current#"$front"}")
        compopt -o filenames 2> /dev/null
    fi
    if [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *= ]]; then compopt -o nospace 2> /dev/null; fi

    # The shell takes what stands behind the last "=" or ":" for the word.
    line=${current%"$seen"}
    if [[ -n $front && -n ${COMPREPLY[*]-} && $line != "$front" ]]; then
        COMPREPLY=("${COMPREPLY[@]/#/$front}")
        COMPREPLY=("${COMPREPLY[@]#"$line"}")
    fi
}

complete -F _stickslip ss-backbone ss-cat ss-contour ss-features ss-filter ss-morlet ss-noise ss-plot ss-rank ss-report \
    ss-signal ss-sim ss-sweep ss-trade
