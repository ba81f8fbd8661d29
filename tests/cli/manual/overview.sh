# The worked example of stickslip(7), from a table to a stiffness and a scene.
(echo 't,a (m/s^2)'
 ss-sim -c t,a compliant-heavy | ss-noise --snr 40 |
     grep -v '^#' | tr '\t' ',') > run.csv
ss-cat run.csv | head -n 4
ss-morlet run.csv -o run.h5
ss-features --mass 2.42 --stiffness 2310 run.csv > run.features
grep -E '^# (transition_f|damping_r|contact_)' run.features | awk '{ printf "%s %s %.4g %.1g\n", $1, $2, $3, $4 }'
if command -v gnuplot > /dev/null; then
    ss-plot run.csv -o run.png
    ss-contour run.h5 -o contour.png
    ss-contour --features run.features run.h5 -o marked.png
fi
ss-rank run.csv | grep -v '^#' | cut -f 1-2
ss-rank --fit run.csv > mine.scene
ss-sim mine.scene | ss-morlet -o mine.h5
ss-sweep --vary contact_damping=10:160:4:log \
    --measure microslips,transition mine.scene | awk '!/^#/ { printf "%s %.3g %s %.4g %s\n", $1, $2, $3, $4, $5 }'
