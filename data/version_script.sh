# version_script.sh HEADER CC FLAGS ...: what the headers declare, as a linker's version script, so that a
# shared library shows these names and no other.
header=$1
shift
echo 'STICKSLIP_1 {'
echo '    global:'
"$@" -x c -E -P "$header" | grep -v '^#' | tr '\n' ' ' | tr ';{}' '\n' | grep -v -e typedef -e '^[^(]*(\*' |
    sed -n -e 's/^.*[ *]\(ss_[a-z0-9_]*\) *(.*/        \1;/p' \
        -e 's/^ *extern const.*[ *]\(ss_[a-z0-9_]*\).*$/        \1;/p' | LC_ALL=C sort -u
echo '    local:'
echo '        *;'
echo '};'
