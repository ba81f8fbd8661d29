# A program that only simulates needs nothing of HDF5 from the static library.
cat > sim.c <<'C'
#include <stickslip.h>
int main(void)
{
    ss_scene scene = ss_scene_defaults;
    return ss_sim_run(&scene, NULL, NULL, NULL) != SS_EINVAL;   /* it lacks a model */
}
C
# shellcheck disable=SC2046  # flags are a list
$CCLD -I"$SRC/include" -o sim sim.c "$BUILD/libstickslip.a" $(pkg-config --libs gsl) -lm
./sim

# Only these know these libraries.
scratch=$PWD
cd "$SRC"
grep -rlE --include='*.[ch]' 'gsl_odeiv2\.h' src tools
grep -rlE --include='*.[ch]' 'include.*fftw3\.h' src tools | sort
grep -rlE --include='*.[ch]' 'hdf5(_hl)?\.h' src tools | grep -v '^src/io/hdf5' || true

# Arrows between folders go down this list only, by includes and by what each object file defines and
# uses; within a folder no files need each other in a circle.  What is printed breaks this.
list='base signal scene motion map io find fit study plot'
grep -rnE --include='*.[ch]' '^#include ("|<stickslip/)' src | sed -E 's/^src\/([^:]*)\.[ch]:[0-9]*:#include ["<](.*)\.h[">].*/includes \1 \2/' > "$scratch/arrows"
cd "$scratch"
find "$BUILD/src" -name '*.o' | while read -r object; do
    file=${object#"$BUILD/src/"} file=${file%.o}
    [ ! -f "$SRC/src/$file.c" ] || nm -g -P "$object" | awk -v file="$file" '
        $2 == "U" { print "uses", file, $1 }
        $2 ~ /^[A-TV-Z]$/ { print "has", file, $1 }'
done >> arrows
awk -v list="$list" '
    # A public header belongs to the folder that defines what it declares.
    function folder(file) {
        sub(/^stickslip\/sim$/, "motion/", file)
        sub(/^stickslip\/morlet$/, "map/", file)
        sub(/^stickslip\/(features|spikes)$/, "find/", file)
        sub(/^stickslip\/rank$/, "fit/", file)
        sub(/^stickslip\/(sweep|trade)$/, "study/", file)
        sub(/^stickslip\/(overlay|table|store)$/, "io/", file)
        sub(/^stickslip\/(status|number)$/, "base/", file)
        sub(/^stickslip\//, "", file)
        sub(/\/.*/, "", file)
        return file
    }
    BEGIN { n = split(list, name, " "); for (i = 1; i <= n; i++) height[name[i]] = i }
    $1 == "has" && NR == FNR { owner[$3] = $2 }
    NR == FNR || $1 == "has" || ($1 == "uses" && !($3 in owner)) { next }
    {
        to = $1 == "uses" ? owner[$3] : $3
        if (folder(to) == folder($2) && $1 == "uses" && to != $2)
            needs[$2, to] = 1
        else if (height[folder($2)] < height[folder(to)])
            print "upwards:", $2, $1, to
    }
    END { for (pair in needs) { split(pair, file, SUBSEP); print "needs", file[1], file[2] } }
' arrows arrows | sort -u > checked
grep -v '^needs' checked || true
# Those that can be reached from each other, each circle on one line.
awk '$1 == "needs" { reach[$2, $3] = 1; file[$2]; file[$3] }
    END {
        for (k in file) for (i in file) if ((i, k) in reach)
            for (j in file) if ((k, j) in reach) reach[i, j] = 1
        for (i in file) if ((i, i) in reach) {
            least = i
            for (j in file) if ((i, j) in reach && (j, i) in reach && j < least) least = j
            print least, i
        }
    }' checked | sort | awk '$1 != last { printf "%scircle:", last == "" ? "" : "\n"; last = $1 }
        { printf " %s", $2 } END { if (NR) print "" }'
