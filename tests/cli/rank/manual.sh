# The EXAMPLES of ss-rank(1).
ss-sim compliant-heavy | ss-noise --snr 20 | ss-rank | grep answer
ss-sim coulomb | ss-rank - coulomb state-variable | tail -n 2 | cut -f 1-2
ss-sim compliant-light | ss-noise --snr 40 > measured.tsv
ss-rank --fit measured.tsv > mine.scene; ss-sim mine.scene | tail -n 1 | cut -f 1
# what was fitted is within 1 % of what was simulated
awk '$1 == "contact_stiffness" { print int($3 / 209900 * 100 + 0.5) }
     $1 == "friction" { print int($3 / 1.28 * 100 + 0.5) }' mine.scene
