# sh tables.sh events|values FIRST|SECOND: the tables of this folder, by the first or the second of two methods that
# differ in kind, with ss-sim in the PATH.
cd "$(dirname "$0")" || exit 1
table=$1
method_of() {    # SCENE
    case $1 in
    *state-variable* | *falling* | *lugre* | *dahl*) [ "$2" = FIRST ] && echo taylor || echo rk8pd ;;
    *) [ "$2" = FIRST ] && echo exact || echo taylor ;;
    esac
}
case $table in
events) printf 'scene\tt/s\tkind\tdirection\tx/m\tv/(m/s)\n' ;;
values) printf 'scene\tt/s\tx/m\tv/(m/s)\tf/N\n' ;;
esac
for file in *.scene; do
    name=${file%.scene}
    how="-q -m $(method_of "$name" "$2") -t 1e-13"
    # shellcheck disable=SC2086  # how is a list
    case $table in
    events)
        case $name in *state-variable | *lugre | *dahl) continue ;; esac
        ss-sim $how --events "$file" | awk -v OFS='\t' -v scene="$name" '!/^#/ { print scene, $1, $2, $5, $3, $4 }' ;;
    values) ss-sim $how -c t,x,v,f "$file" | awk -v OFS='\t' -v scene="$name" '!/^#/ { print scene, $1, $2, $3, $4 }' ;;
    esac
done
