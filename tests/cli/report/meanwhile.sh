# What happens while a report is made: it is stopped, or another takes its name.  Tools that it calls do that, so it
# happens at the same moment on every machine.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim --set duration=1 --columns t,a compliant-light > run.tsv
ss-sim --set duration=1 --columns t,a coulomb > other.tsv
usual=$PATH scratch=$PWD
export usual scratch

# at TOOL DEED: the next report does the deed as it calls the tool the first time.
at() {
    rm -rf bin
    mkdir bin
    {
        echo '#!/bin/sh'
        echo 'PATH=$usual'
        echo "[ -e \"\$scratch/hit\" ] || { : > \"\$scratch/hit\"; $2; } > \"\$scratch/deed\" 2>&1"
        echo "exec $1 \"\$@\""
    } > "bin/$1"
    chmod 755 "bin/$1"
    rm -f hit deed
}
report() { (PATH=$scratch/bin:$PATH; export PATH; exec sh -c 'echo $$ > pid; exec ss-report -q "$@"' sh "$@"); }
hit() { if [ -e hit ]; then echo "at $1"; else echo "never at $1"; fi; }

for tool in ss-features ss-plot ss-morlet ss-contour; do
    # shellcheck disable=SC2016  # expanded there
    at $tool 'kill "$(cat "$scratch/pid")"'
    report -o stopped run.tsv other.tsv || echo "status $?"
    hit $tool
done
ls -d stopped* 2> /dev/null || echo "nothing left"

echo "--- another report, a folder, a link, with mv as it is and one that has no -T"
ss-report -q -o right run.tsv
ss-report -q -o second other.tsv
for mv in 'mv' 'mv -T'; do
    for deed in 'ss-report -q -o rep other.tsv' 'mkdir rep' 'ln -s nowhere rep'; do
        at ss-contour "cd \"\$scratch\" && $deed"
        if [ "$mv" = mv ]; then
            printf '#!/bin/sh\n[ "$1" != -T ] || exit 64\nPATH=$usual exec mv "$@"\n' > bin/mv
            chmod 755 bin/mv
        fi
        report -o rep run.tsv || echo "status $?"
        hit "$deed"
        case $deed in
        ss-report*) diff -r second rep ;;
        mkdir*) find rep -mindepth 1 ;;
        ln*) [ -L rep ] || echo "the link is gone" ;;
        esac
        cat deed
        ls -d rep?* 2> /dev/null || :
        rm -r rep
    done
    report -q -o rep run.tsv
    diff -r right rep
    rm -r rep
done

echo "--- a run that failed or was killed does not block the next"
touch empty.csv
ss-report -q -o rep empty.csv 2> /dev/null || echo "status $?"
# shellcheck disable=SC2016  # expanded there
at ss-plot 'kill -9 "$(cat "$scratch/pid")"'
(report -o rep run.tsv || echo "status $?") 2> /dev/null
hit killed
report -o rep run.tsv
diff -r right rep
