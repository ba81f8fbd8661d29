# NumPy's .npy: what numpy.save writes, in every order and version, and what is not an array of a signal.
python3 -c 'import numpy' 2> /dev/null || { echo "no numpy"; exit 77; }
refused() { "$@" || echo $?; }
cat > make.py <<'PY'
import numpy as np
a = np.array([[1, 2], [-3, 4], [5, 100]])
for name in "i1 u1 i2 u2 i4 u4 i8 u8 f4 f8".split():
    for order in "<>":
        signed = np.abs(a) if name[0] == "u" else a
        np.save(f"{name}{'le' if order == '<' else 'be'}.npy", signed.astype(order + name))
np.save("fortran.npy", np.asfortranarray(a.astype("f8")))
np.save("wide.npy", a.T.astype("f8"))
np.save("wide-fortran.npy", np.asfortranarray(a.T.astype("f8")))
np.save("vector.npy", np.linspace(0, 1, 5))
np.save("flags.npy", np.array([True, False]))
for version in (1, 2, 3):
    with open(f"version{version}.npy", "wb") as out:
        np.lib.format.write_array(out, a.astype("f8"), version=(version, 0))
with open("many.npy", "wb") as out:
    np.lib.format.write_array(out, np.zeros(2, [(f"c{i}", "<f8") for i in range(32769)]), version=(2, 0))
fields = np.zeros(4, [("t", "<f8"), ("force", ">f4"), ("count", "<i2")])
fields["t"] = np.arange(4) / 1000
fields["force"] = [1.5, 2.5, -3.5, 4.5]
fields["count"] = [1, -2, 3, -4]
np.save("fields.npy", fields)
padded = np.zeros(4, np.dtype({"names": ["t", "force"], "formats": ["<f8", "<f4"], "offsets": [0, 12], "itemsize": 24}))
padded["force"] = fields["force"]
np.save("padded.npy", padded)
long = np.arange(900000).reshape(300000, 3) / 4
np.save("long.npy", long)
np.save("long-fortran.npy", np.asfortranarray(long))
np.save("long-wide.npy", long.T)
np.save("long-wide-copied.npy", long.T.copy())
np.save("nan.npy", np.array([1, np.nan, 3.]))
np.save("complex.npy", a * 1j)
np.save("half.npy", a.astype("f2"))
np.save("cube.npy", np.zeros((2, 2, 2)))
np.save("empty.npy", np.zeros((0, 2)))
np.save("single.npy", np.float64(3))
np.save("nested.npy", np.zeros(3, [("x", "<f8", (3,))]))
np.save("objects.npy", np.array(["a", 1], dtype=object))
PY
python3 make.py
for name in i1 i2 i4 i8 f4 f8; do
    for order in le be; do ss-cat --rate 10 $name$order.npy > $name$order.tsv; cmp i1le.tsv $name$order.tsv; done
done
for name in u1 u2 u4 u8; do
    for order in le be; do ss-cat --rate 10 $name$order.npy > $name$order.tsv; cmp u1le.tsv $name$order.tsv; done
done
for file in fortran wide wide-fortran version1 version2 version3; do ss-cat --rate 10 $file.npy | cmp i1le.tsv -; done
awk 'BEGIN { for (i = 0; i < 900000; i += 3) printf "%.9g\t%.9g\t%.9g\n", i / 4, (i + 1) / 4, (i + 2) / 4 }' \
    > long.tsv
for file in long long-fortran long-wide long-wide-copied; do
    ss-cat --rate 10 $file.npy -c ch1 -c ch2 -c ch3 | grep -v '^#' | cut -f 2- | cmp long.tsv -
done
cat i1le.tsv
ss-cat --rate 10 vector.npy
ss-cat --rate 10 flags.npy | tail -n 2
ss-cat fields.npy
ss-cat --time-unit ms fields.npy | head -n 2
ss-cat --rate 5 -c force padded.npy | tail -n 4
ss-cat --time 2 --gaps split i1le.npy > none || echo $?
refused ss-cat --rate 10 nan.npy
ss-cat --rate 10 --gaps interpolate nan.npy | tail -n 2
for file in vector complex half cube empty single nested objects many; do refused ss-cat $file.npy; done
# Headers that lie: never more memory than the file has bytes for.
head -c 150 f8le.npy > cut.npy
refused ss-cat --rate 10 cut.npy
{ cat f8le.npy; echo; } > more.npy
refused ss-cat --rate 10 more.npy
sed 's/}      /} + x()/' f8le.npy > code.npy
refused ss-cat --rate 10 code.npy
# A key twice; records in "Fortran order", which are what they are in the other.
header() { printf '\223NUMPY\001\000\340\001%-479s\n' "$1"; }
twice="'descr': '<f8', "
{ header "{$twice$twice$twice$twice$twice$twice$twice'fortran_order': False, 'shape': (4,), }"; head -c 8000 /dev/zero; } > twice.npy
refused ss-cat --rate 10 twice.npy
{ header "{'descr': '<f8', 'fortran_order': False, 'shape': (1,), 'shape': (2,), }"; head -c 8000 /dev/zero; } > shape.npy
refused ss-cat --rate 10 shape.npy
sed 's/False/True /' fields.npy > fields-fortran.npy
ss-cat fields-fortran.npy > f.tsv
ss-cat fields.npy | cmp f.tsv -
sed 's/(3, 2)/(99999999999, 2)/' f8le.npy > huge.npy
# shellcheck disable=SC3045  # a limit where the shell has one
([ -n "$SAN" ] || ulimit -v 500000 2> /dev/null || true; refused ss-cat --rate 10 huge.npy)
head -c 40 f8le.npy > header.npy
refused ss-cat --rate 10 header.npy
printf '\223NUMPY\002\000\377\377\377\177{' | refused ss-cat --rate 10
printf '\223NUMPY\007\000\020\000{aaaaaaaaaaaaaaa' | refused ss-cat --rate 10
printf 'MATLAB 5.0 MAT-file, Platform' | refused ss-cat
printf 'TDSm0000000000000' | refused ss-cat
