# Separators of thousands are refused with line and column, in the first row or later; a decimal comma is none.
try() { printf "$@" > run.csv; ss-cat -q -o out.tsv run.csv || echo "exit $?"; [ ! -e out.tsv ]; }
try 't,x\n0,"1,234.5"\n1,"2,234.5"\n2,"3,234.5"\n'
try 't,x\n0,"1,234"\n1,"2,234"\n2,"3,234"\n'
try 't,x\n0,999\n1,"1,234"\n2,"2,234"\n'
try 't,x\n0,"1,234"\n1,999\n2,999\n'
try "t,x\n0,1'234.5\n1,2'234.5\n2,3'234.5\n"
try 't;x\n0;1 234,5\n1;2 234,5\n2;3 234,5\n'
try 't\tx\n0\t1 234,5\n1\t2 234,5\n2\t3 234,5\n'
try 't;x\n0;-1.234,5\n1;2.234,5\n2;3.234,5\n'
try 't;x\n0;123,5\n1;999,5\n2;1.234,5\n'
try 't;x\n0;1.234.567\n1;2.234.567\n2;3.234.567\n'
try 't\tx\n0\t1,234.5\n1\t2,234.5\n2\t3,234.5\n'
try 't;x\n0;1\302\240234,5\n1;2\302\240234,5\n2;3\302\240234,5\n'
try 't;x\n0;1\342\200\257234,5\n1;2\342\200\257234,5\n2;3\342\200\257234,5\n'
try "t;x\n0;1\342\200\231234.5\n1;2\342\200\231234.5\n2;3\342\200\231234.5\n"
echo "-- other columns can be chosen; other texts in the shape of a number are only left out"
printf 't_s,n,x,version\n0,"1,234.5",3,1.2.3\n1,"2,234.5",4,1.2.3\n2,"3,234.5",5,1.2.3\n' > run.csv
ss-cat -c x run.csv | tail -n 1
printf 't_s,x,version,a,b,c\n0,3,1.2.3,"1,23","1234,567.8","1,234.567.8"\n1,4,1.2.3,"1,23","1,23","1,23"\n' | ss-cat | tail -n 1
echo "-- a decimal comma"
printf 't_s;x\n0;1,234\n1;2,234\n2;3,25\n' | ss-cat | tail -n 1
for rows in '999\n1;1,234' '999\n1;1.234' '999\n1;0,234' '999\n1;1,25' '1,234\n1;2,234'; do
    printf "t_s;x\n0;$rows\n2;3\n" | ss-cat | sed -n '6p'
done
printf 't_s\tx\n0\t999\n1\t1.234\n' | ss-cat | tail -n 1      # a point is no sign of thousands there
