# A friction model is a file and a row: a copy of state_variable.c under another name, with a key that
# no model has, and its row in the list of models.h; no other header changes.  Every tool then works with it as it does with the
# original, or refuses in one clear line.  So it does with a copy of coulomb.c that says neither that
# it is linear nor its higher derivatives.  Without its row it does not compile.  The law of CONTRIBUTING.md is a
# file and a row, too.
. "$SRC/tests/build/block.inc"
block src/scene/rounded.c > rounded.c
sed -e 's/MODEL(state_variable)/MODEL(copied)/' -e 's/ss_state_variable_model/ss_copied_model/' \
    -e 's/"state-variable"/"copied"/' -e 's/"alpha"/"front_slope"/' "$SRC/src/scene/state_variable.c" > copied.c
sed -e 's/MODEL(coulomb)/MODEL(stepped)/' -e 's/ss_coulomb_model/ss_stepped_model/' -e 's/ss_to_coulomb/ss_to_stepped/' \
    -e 's/"coulomb"/"stepped"/' -e 's/ \.linear = 1,//' -e 's/ \.derivatives = ss_linear_derivatives,//' \
    -e 's/ *\.variation = .*//' "$SRC/src/scene/coulomb.c" > stepped.c
# shellcheck disable=SC2086  # flags are lists
compile() { $CC -std=c11 -D_XOPEN_SOURCE=700 -O2 -Iown -I"$SRC/include" -I"$SRC/src" $INCLUDES -c "$@"; }
compile copied.c 2> refused || grep -c 'MODEL_copied' refused
mkdir -p own/scene
sed '/^#define MODEL_LIST/s/$/\n    row(copied) \\\n    row(stepped) \\\n    row(rounded) \\/' "$SRC/src/scene/models.h" > own/scene/models.h
compile copied.c stepped.c rounded.c "$SRC/src/scene/models.c"
mkdir bin
common=
for source in "$SRC"/tools/*.c; do
    name=$(basename "$source" .c)
    case $name in ss-* | paper-*) ;; *) common="$common $BUILD/tools/$name.o" ;; esac
done
for tool in sim trade rank sweep; do
    # what is linked first takes the place of the library's models.o
    # shellcheck disable=SC2086
    $CCLD -o bin/ss-$tool "$BUILD/tools/ss-$tool.o" $common models.o copied.o stepped.o rounded.o \
        "$BUILD/libstickslip.a" $LIBS &
done
wait
sim() { bin/ss-sim -s duration=0.2 -s settle=0 "$@"; }
refused() { "$@" > refused.out || echo "exit $?"; cat refused.out; }
ss-sim --list state-variable > original.scene
sed -e 's/^model = .*/model = copied/' -e 's/^alpha/front_slope/' original.scene > named.scene
bin/ss-sim --list named.scene > copied.scene
diff original.scene copied.scene || true

echo '-- ss-sim, by every method'
for method in $(ss-sim --list | sed -n 's/^methods: *exact//p'); do
    case $method in
    rk1imp)      tol=1e-3 ;;
    rk2* | rk4*) tol=1e-6 ;;
    *)           tol=1e-9 ;;
    esac
    for scene in copied original; do
        sim -m "$method" -t $tol $scene.scene | grep -v '^# ' > $scene.tsv
    done
    cmp copied.tsv original.tsv && echo "$method: $(grep -c . copied.tsv)"
done
for scene in copied original; do
    sim --accuracy 1e-6 $scene.scene | grep -v '^# ' > $scene.tsv
done
cmp copied.tsv original.tsv && echo "--accuracy: $(grep -c . copied.tsv)"
refused sim -m exact copied.scene
refused sim -m exact --accuracy 1e-6 copied.scene
refused sim -s contact_damping=3 copied.scene
refused sim -s alpha=3 copied.scene
refused sim -s front_slope=-1 copied.scene
refused sim -s model=coulumb copied.scene
sim --events copied.scene | grep -v '^# [a-z0-9_]*: [a-z0-9.-]*$'

echo '-- ss-trade'
bin/ss-trade -b 0.1 -s duration=0.05 -s settle=0 copied.scene | sed '/^#/d' | cut -f 1 | uniq -c
bin/ss-trade --target 1e-6 -s duration=0.05 -s settle=0 copied.scene | sed 's/ [a-z0-9]* --tol .*/ .../'

echo '-- ss-rank'
bin/ss-sim copied.scene > signal.tsv
ss-sim --list coulomb > coulomb.scene
bin/ss-rank signal.tsv coulomb.scene copied.scene > ranking.tsv
sed -n 's/^\(# answer.*explains\).*/\1/p' ranking.tsv
refused bin/ss-rank --fit signal.tsv copied.scene

echo '-- ss-sweep'
for scene in copied original; do
    bin/ss-sweep --vary friction=1.2:1.28:2 --measure amplitude,energy,transition,period,floquet $scene.scene |
        grep -v '^# \(scene\|model\|alpha\|front_slope\)' > $scene.tsv
done
cmp copied.tsv original.tsv && tail -n 2 copied.tsv | cut -f 8
refused bin/ss-sweep --vary friction=0.5:1:2 --measure stops copied.scene
refused bin/ss-sweep --vary contact_damping=1:2:2 copied.scene

echo '-- a model with events that is not linear'
ss-sim --list coulomb > original.scene
bin/ss-sim --list -s model=stepped original.scene > stepped.scene
for method in rk8pd rk4imp bsimp radau; do        # event times to 1e-6 of an interval between two
    for scene in stepped original; do
        bin/ss-sim -s settle=0 -s duration=1 -m $method -t 1e-9 --events $scene.scene | grep -v '^# ' > $scene.tsv
    done
    paste stepped.tsv original.tsv |
        awk -v method=$method '{ far += $2 != $7 || $5 != $10 || ($1 - $6) ^ 2 > 1e-14 }
            END { print method ": " NR " events, " far + 0 " elsewhere" }'
done
refused sim -m msadams stepped.scene
refused sim -m exact stepped.scene
sim --accuracy 1e-8 --events stepped.scene | grep -vc '^# '
bin/ss-trade -b 0.1 -s duration=0.2 -s settle=0 stepped.scene | sed '/^#/d' | cut -f 1 | uniq -c
bin/ss-sim stepped.scene > signal.tsv
ss-sim --list state-variable > other.scene
bin/ss-rank signal.tsv other.scene stepped.scene | sed -n 's/^\(# answer.*explains\).*/\1/p'
for scene in stepped original; do
    bin/ss-sweep --vary friction=0.5:1:2 --measure stops,stick,amplitude $scene.scene |
        grep -v '^#' > $scene.tsv
done
paste stepped.tsv original.tsv | awk '{ print $3, $9, ($5 / $11 - 1) ^ 2 < 1e-16 }'
refused bin/ss-sweep --vary friction=0.5:1:2 --measure floquet stepped.scene
refused bin/ss-sweep --vary friction=0.5:1:2 --shoot stepped.scene

echo '-- the law of CONTRIBUTING.md'
sed 's/^model = .*/model = rounded\nrounding_velocity = 1e-5/' original.scene > rounded.scene
bin/ss-trade --models -s duration=0.5 -s settle=0.5 rounded.scene | awk '!/^#/ { print $1, ($2 < 0.05) }'
refused bin/ss-sim -s rounding_velocity=0 rounded.scene
