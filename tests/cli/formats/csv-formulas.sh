# A name that a spreadsheet would take for a formula is text in CSV; numbers below 0 stay numbers.
printf 't_s,=cmd|x,+1+1,-2-3,@SUM(A1),"=a,""b"""\n' > names
{ cat names; awk 'BEGIN { for (i = 0; i < 400; i++) printf "%.3f,%.4f,-1.5,%d,-2,-1e-5\n", i / 1000, sin(i), i % 2 ? -1 : 1 }'; } > '=run.csv'
ss-cat --format csv '=run.csv' | sed -n 1,3p
ss-cat -o out.csv '=run.csv'
sed 1q out.csv
ss-plot --spectrum -c 1 -c 2 -o spectrum.csv '=run.csv'
sed 1q spectrum.csv
ss-features --summary -c 1 --format csv '=run.csv' '=run.csv' | cut -c1-12
ss-sweep --vary x0=-1:1:3 -m amplitude --format csv coulomb | cut -d, -f1-2
# in a text of ours, where cells are no formulas, names are as they are
ss-cat '=run.csv' | grep '^# columns'
