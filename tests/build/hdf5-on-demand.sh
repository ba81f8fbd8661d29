# Tools load HDF5 only for a file that needs it, with the library that they were built or installed with.
[ -z "$SAN" ] || { echo "a tool with sanitizers loads more"; exit 77; }
[ -f "$BUILD/libstickslip.so" ] || { echo "no ELF library"; exit 77; }
command -v readelf > /dev/null || { echo "no readelf"; exit 77; }
library=$(readlink -f "$BUILD/libstickslip.so")
for file in "$BUILD"/bin/ss-*; do
    ! readelf -d "$file" 2> /dev/null | grep 'NEEDED.*hdf5' || basename "$file"
done
ss-sim --set duration=1 -o run.h5 coulomb
ss-cat run.h5 > run.tsv

# Installed, the library in the usual place or one of its own, it is found before any other of its name.
mkdir tree elsewhere
cp -a "$BUILD"/src "$BUILD"/tools "$BUILD"/bin "$BUILD"/flags "$BUILD"/libdir "$BUILD"/*.* tree
echo none > elsewhere/"${library##*/}"
for place in lib own/place; do
    "$MAKE" -s -C "$SRC" BUILD="$PWD/tree" PREFIX="$PWD/root" LIBDIR="$PWD/root/$place" install > log 2>&1 || cat log
    for file in root/bin/ss-* root/$place/*.so; do
        ! readelf -d "$file" 2> /dev/null | grep -E 'RPATH|RUNPATH' || echo "in ${file##*/}"
    done
    LD_LIBRARY_PATH=elsewhere root/bin/ss-cat run.h5 | cmp - run.tsv || echo "$place: not read"
    rm -r root
done

# A tool without its library says so in one line, and leaves nothing.
mkdir alone
cp "$BUILD/bin/ss-cat" "$BUILD/bin/ss-sim" alone
! alone/ss-cat run.h5 2> words || echo "no failure"
! alone/ss-sim -o alone/run.h5 coulomb 2>> words || echo "no failure"
sed 's/: [^:]*libstickslip.*//' words
alone/ss-cat run.tsv | cmp - run.tsv
ls alone
