# What cannot be transformed: no such file or column, nothing, NaN.
try() { ss-morlet "$@" 2>&1 || echo "exit $?"; }
printf 't,left,right\n0,1,2\n1,2,3\n2,3,4\n' > two.csv
printf '# stickslip signal 1\n# rate: 10\n# start: 0\n# columns: t/s a\n0\t1\n0.1\tnan\n' > nan.tsv
: > empty
try none.tsv
try .
try empty
try two.csv
try --column a two.csv
try --column 3 two.csv
try nan.tsv
