# More files at once than a process may open.
[ -z "$SAN" ] || { echo "sanitizers need descriptors of their own"; exit 77; }
ss-sim -q -s duration=0.1 coulomb -o run.tsv
(ulimit -n 16; exec ss-features --jobs 20 $(yes run.tsv | head -n 40)) || echo "status $?"
