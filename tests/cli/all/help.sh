# The help of every tool fits a terminal of 24 lines of 80.
for tool in "$BUILD"/bin/ss-*; do
    "$tool" --help | awk -v name="${tool##*/}" 'length > 80 { print name " is too wide: " $0 }
        /@/ { print name ": " $0 } END { if (NR > 24) print name " has " NR " lines" }'
done
