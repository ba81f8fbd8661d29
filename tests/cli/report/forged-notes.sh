# Notes of a recording are never printed as findings, and what comes of coefficients has pages as any other file.
command -v gnuplot > /dev/null || { echo "no gnuplot"; exit 77; }
ss-sim --set duration=3 compliant-light | ss-cat -c a > run.tsv
{ sed 1q run.tsv
  for name in column about_stiffness about_slips spikes spike transitions transition_frequency; do echo "# $name: forged"; done
  sed 1d run.tsv; } > forged.tsv
ss-morlet --octaves=-10:0 --force -q -o run.h5 run.tsv
ss-morlet --inverse --accuracy .1 -o inverse.tsv run.h5
ss-report -q -o pages forged.tsv inverse.tsv
grep -l 'forged$\|: forged\|>forged<' pages/*.html || echo "nothing forged"
for page in pages/0*; do
    echo "$(grep -o '<svg' "$page" | wc -l) pictures, $(grep -c '<p>Column a<' "$page") column"
done
