# Completion in bash and zsh: the same in both, and every option of every tool.
command -v bash > /dev/null || { echo "no bash"; exit 77; }
ss-sim compliant-light --set duration=0.01 --set settle=0 -o run.tsv
ss-sim --list coulomb -o my.scene
{
    cat <<'LINES'
ss-sim --ev
ss-sim --max
ss-sim comp
ss-sim c
ss-sim --method rk8
ss-sim -m ex
ss-sim --method=ms
ss-sim --columns t,x,m
ss-sim coulomb --set
ss-sim my.scene --set=m
ss-sim --set law=
ss-sim --set=release=s
ss-sweep coulomb --vary f
ss-sweep state-variable -y al
ss-sweep --measure=stops,x_
ss-morlet run.tsv --col
ss-plot run.tsv --column
ss-plot run.tsv -c
ss-plot run.tsv --column=a
ss-plot run.tsv --xy x,a
ss-plot run.tsv --map=
ss-plot --xy
ss-noise none.tsv -c
ss-cat ru
ss-morlet -o ru
ss-signal ch
ss-signal
ss-rank my.
ss-morlet --accuracy
LINES
    # Options as the tools' own tables have them; what each of them takes.
    for tool in "$SRC"/tools/ss-*.c; do
        name=$(basename "$tool" .c)
        echo "$name --"
        set -- "$tool" "$SRC/tools/options.c"
        ! grep -q 'tool_reading reading' "$tool" || set -- "$@" "$SRC/tools/reading.c"
        grep -ohE 'TOOL_[A-Z]+\([^,()]*, "[a-z-]+"|TOOL_(OUTPUT|FORMAT|METHOD|STYLE|THREADS)[A-Z_]*\(' "$@" |
            sed -e 's/.*_\([A-Z]*\)(.*"\(.*\)"/\2 \1/' -e 's/_OF_WORDS//' -e 's/TOOL_\(.*\)(/\1 VALUE/' | tr A-Z a-z |
            sort -u | tee "$name.options" | sed -n -e '/ flag$/d' -e '/ call$/d' -e "s/\(.*\) .*/$name --\1=/p" |
            grep -v -e '--output=' -e '--events=' -e '--features=' -e '--line=' -e '--signal=' \
                -e '--residual=' -e '--resume=' -e '--over=' -e '--base=' -e '--follow='    # files
    done
} > lines

# A column of a stranger's file is completed, quoted, and never run.
printf '# stickslip signal 1\n# rate: 1\n# start: 0\n# columns: t/s $(touch${IFS}ran)/m `touch${IFS}ran`/m b/m\n0\t1\t2\t3\n' \
    > theirs.tsv
bash -eu <<'BASH'
compopt() { :; }
. "$SRC/data/completion/stickslip.bash"
COMP_LINE='ss-plot theirs.tsv -c ' COMP_POINT=22
_stickslip ss-plot '' -c
printf '%s\n' "${COMPREPLY[@]}"
[[ ! -e ran ]] || echo 'a name was run'
rm -f theirs.tsv
BASH

# "LINE: what it may go on with", sorted, without what the line has of it.  Lines end in a blank unless
# the word goes on.
sed -e 's/--set$/& /' -e 's/--column$/& /' -e 's/ -c$/& /' -e 's/--xy$/& /' -e 's/^ss-signal$/& /' \
    -e 's/accuracy$/& /' lines > asked
bash -eu > in-bash <<'BASH'
compopt() { :; }
. "$SRC/data/completion/stickslip.bash"
while IFS= read -r line; do
    COMP_LINE=$line COMP_POINT=${#line}
    word=${line##*[[:space:]]}
    _stickslip "${line%% *}" "${word##*[=:]}" ''
    echo "$line: $(printf '%s\n' "${COMPREPLY[@]-}" | sed -e 's/.*,//' -e 's/=$//' | sort | xargs)"
done < asked
BASH

sed -n '/^ss-[a-z]* --: /!p' in-bash
sed -n 's/^\(ss-[a-z]*\) --: /\1 /p' in-bash | while read -r tool options; do
    echo "$options" | tr ' ' '\n' | sed 's/^--//' | sort > offered
    sed 's/ .*//' "$tool.options" | sort | diff - offered || echo "of $tool"
done
# Every tool and none else.
for tool in "$SRC"/tools/ss-*.c; do
    name=$(basename "$tool" .c)
    for file in "$SRC"/data/completion/*; do grep -qw -e "$name" "$file" || echo "$name is not in $file"; done
done

# In a zsh with a terminal, whose compadd says what it is given.
command -v zsh > /dev/null || exit 0
cat > in.zsh <<'ZSH'
zmodload zsh/zpty || exit 0
zpty z zsh -f -i
zpty -w z 'PROMPT=; stty -echo; fpath=($SRC/data/completion $fpath); autoload -U compinit; compinit -u -D; unsetopt autolist
zstyle ":completion:*" completer _complete
compadd() {
    if [[ ${@[1,(i)(-|--)]} == *-(O|A|D)\ * ]]; then builtin compadd "$@"; return $?; fi
    local -a hits
    builtin compadd -A hits "$@"
    print -rl -- $hits >> found
    builtin compadd "$@"
}
ask() { _main_complete; : > done }
zle -C ask complete-word ask
bindkey "^T" ask
print READY'
zpty -r z x '*READY*'
while IFS= read -r line; do
    rm -f found done
    : > found
    zpty -w -n z "$line"$'\024'
    repeat 3000; do                  # and the shell must be rid of its output
        [[ -f done ]] && break
        zpty -r -t z x || sleep 0.01
    done
    print -r -- "$line: ${(j: :)${(f)"$(sort -u found)"}}"
    zpty -w -n z $'\025'
done < asked
zpty -d z
ZSH
zsh -f in.zsh > in-zsh
diff in-bash in-zsh
