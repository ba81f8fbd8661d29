# The same bytes from two builds: of other paths, zones of time, locales, umasks and numbers of jobs.
git -C "$SRC" rev-parse --git-dir > /dev/null 2>&1 || { echo "not a clone"; exit 77; }
clean() { env -i PATH="$PATH" HOME="$PWD" INSTALL_DEPS=0 "$@"; }
build() {       # DIRECTORY JOBS VARIABLE=VALUE ...
    into=$1 jobs=$2
    shift 2
    mkdir -p "$into"
    clean "$@" "$MAKE" -s -C "$SRC" dist BUILD="$PWD/$into"
    tar xzf "$into"/libstickslip-*.tar.gz -C "$into"
    mv "$into"/libstickslip-*/ "$into/tree"
    clean "$@" "$MAKE" -s -j"$jobs" -C "$into/tree" CC="${CC#ccache }" all
    (cd "$into/tree/build" && PATH="$PWD/bin:$PATH" && clean "$@" PATH="$PATH" sh -eu -c '
        ss-sim compliant-light -o run.tsv; ss-morlet run.tsv -o run.h5; ss-contour run.h5 -o run.gp; ss-plot run.tsv -o plot.gp')
}
(umask 022; build one 1 TZ=UTC0 LC_ALL=C)
(umask 077; build elsewhere/two 2 TZ=XYZ-11 LOCPATH="${LOCALES-}" LC_ALL=de_DE.UTF-8)
cmp one/libstickslip-*.tar.gz elsewhere/two/libstickslip-*.tar.gz
cd one/tree/build
find . -type f ! -name '*.d' ! -name flags | sort > ../files
grep -qx ./libstickslip.a ../files && grep -qx ./bin/ss-sim ../files && grep -qx ./run.h5 ../files
while read -r file; do
    cmp "$file" "../../../elsewhere/two/tree/build/$file" || :
done < ../files
