# Standard input has one reader.
ss-sim -s duration=1 coulomb > run.tsv
ss-sweep --vary friction=0.1:1:3 coulomb > map.tsv
ss-plot --over - - < run.tsv > drawn || echo $?
ss-plot --map friction,amplitude --line - - < map.tsv > drawn || echo $?
ss-rank - - < run.tsv || echo $?
ss-features -j 2 - - < run.tsv || echo $?
