# Every tool has a manual page, and mandoc finds nothing to say about any.
command -v mandoc > /dev/null || { echo "no mandoc"; exit 77; }
for tool in "$BUILD"/bin/ss-*; do
    [ -f "$SRC/man/${tool##*/}.1" ] || echo "no man page: ${tool##*/}"
done
# Every public name is declared in a header that is installed: the headers are the reference.
[ ! -f "$BUILD/libstickslip.so" ] ||
    nm -D --defined-only "$BUILD/libstickslip.so" | sed -n 's/.* \(ss_[a-z0-9_]*\).*/\1/p' | while read -r name; do
        grep -qw -e "$name" "$SRC"/include/stickslip/*.h || echo "in no header: $name"
    done
cd "$SRC/man"
mandoc -T lint ./*.[1-9]
# Each fits a terminal of 80 columns, and tables keep their columns.
for page in *.[1-9]; do
    mandoc -T utf8 -O width=80 "$page" | LC_ALL=C tr -d '\200-\277' | LC_ALL=C sed "s/.$(printf '\b')//g" |
        awk -v page="$page" 'length($0) > 80 { print "wider than 80 columns: " page ": " $0 }'
    ! grep -q '^\.Bl -column' "$page" || awk -v page="$page" '
        /^\.Bl -column/ { n = split($0, width, "\""); column = 1 }
        /^\.El/ { column = 0 }
        column && /^\.It / {
            gsub(/^\.It |Sy /, ""); k = split($0, cell, / Ta /)
            for (i = 1; i < k; i++) if (length(cell[i]) > length(width[2 * i])) print "wider than its column: " page ": " cell[i]
        }' "$page"
done
# stickslip(3) as it is installed has the headers, to the letter.
mandoc -T lint "$BUILD/stickslip.3"
mandoc -T utf8 -O width=200 "$BUILD/stickslip.3" | LC_ALL=C sed -e "s/.$(printf '\b')//g" -e 's/^ *//' > "$OLDPWD/page"
sed 's/^[ 	]*//' "$SRC"/include/stickslip/*.h | grep . | grep -vxF -f "$OLDPWD/page" || true
# stickslip-features(7) names each number of the list.
printf '#include <stickslip.h>\n#define NUMBER(NAME, name, unit, about, needs, by) @ name\nSS_FEATURE_NUMBER_LIST(NUMBER)\n' |
    $CC -I"$SRC/include" -x c -E -P - | grep -o '@ "[a-z_]*"' | tr -d '@ "' > "$OLDPWD/numbers"
[ -s "$OLDPWD/numbers" ] || echo "no numbers"
while read -r name; do
    grep -qE "^\\.(Cm|It)( .*)? $name( |\$)" ./stickslip-features.7 || echo "not in stickslip-features(7): $name"
done < "$OLDPWD/numbers"
# stickslip-scene(5) names each key of a law.
sed -n 's/.*OWN_\(NUMBER\|WORD\)("\([a-z0-9_]*\)".*/\2/p' "$SRC"/src/scene/*.c > "$OLDPWD/keys"
[ -s "$OLDPWD/keys" ] || echo "no keys"
while read -r key; do
    grep -qE "^\\.(Cm|It)( .*)? $key( |\$)" ./stickslip-scene.5 || echo "not in stickslip-scene(5): $key"
done < "$OLDPWD/keys"
# What a user reads first is short.
for bound in README.md:140 CHANGELOG.md:40; do
    [ "$(wc -l < "$SRC/${bound%:*}")" -le "${bound#*:}" ] || echo "longer than ${bound#*:} lines: ${bound%:*}"
done
