# Added piece by piece or to the whole record, the noise is the same.
ss-signal sine > clean.tsv
ss-noise --rms 0.1 clean.tsv | grep -v '^#' > pieces
ss-noise --snr 16.98970004336019 clean.tsv | grep -v '^#' > whole
paste pieces whole | awk '{ d = $2 - $4; if (d * d > e) e = d * d } END { print (e < 1e-24) }'
ss-noise --snr 20 --seed 5 clean.tsv | head -n 2
printf 't,x,y\n0,1,2\n1,1,3\n' | ss-noise --snr 20 -c x
