//! Exhaustive test of the reciprocal, for every mantissa.

use glint_model::triangle::reciprocal::{Reciprocal, SEED, recip};

#[test]
fn every_mantissa() {
    let s18 = -(1i64 << 17)..1 << 17;
    let (mut worst, mut worst_at, mut sum, mut last) = (0.0, 0, 0.0, u32::MAX);
    let [mut e0_range, mut e1_range] = [[i64::MAX, i64::MIN]; 2];
    for m in 1i64 << 23..1 << 24 {
        // The reciprocal, following the steps in docs/formats/triangle.md.
        let y0 = i64::from(SEED[(m >> 15 & 0xFF) as usize]);
        let e0 = ((1 << 33) - m * y0) >> 8;
        let y1 = (y0 * (1 << 7) + ((y0 * e0) >> 18)).min((1 << 17) - 1);
        let e1 = ((1 << 40) - m * y1) >> 8;
        let y = (y1 * (1 << 7) + ((y1 * e1 + (1 << 24)) >> 25)).min((1 << 24) - 1);

        assert!(
            s18.contains(&e0) && s18.contains(&e1),
            "s18 at {m}: {e0}, {e1}"
        );
        assert!((0..1 << 17).contains(&y1), "u0.17 at {m}: {y1}");
        assert!((1 << 23..1 << 24).contains(&y), "u0.24 at {m}: {y}");
        assert_eq!(i64::from(recip(m as u32)), y, "at {m}");
        assert!(recip(m as u32) <= last, "rises at {m}");
        last = recip(m as u32);

        // 2^47 and the product m·y are exact in 64 bits, and their difference is exact as an f64.
        let error = ((1i64 << 47) - m * y).abs() as f64 / m as f64;
        if m != 1 << 23 && error > worst {
            (worst, worst_at) = (error, m);
        }
        sum += error * error;
        e0_range = [e0_range[0].min(e0), e0_range[1].max(e0)];
        e1_range = [e1_range[0].min(e1), e1_range[1].max(e1)];
    }
    let rms = (sum / f64::from(1 << 23)).sqrt();
    println!(
        "error of the reciprocal: at most {worst:.4} units (at {worst_at}), RMS {rms:.4}; e0' in {e0_range:?}, e1' in {e1_range:?}"
    );
    assert!(worst <= 0.51, "{worst} units at {worst_at}");
    assert_eq!(recip(1 << 23), (1 << 24) - 1);
}

#[test]
fn seeds_are_nearest() {
    for (i, &seed) in SEED.iter().enumerate() {
        assert_eq!(
            f64::from(seed),
            (1024.0 / (1.0 + (i as f64 + 0.5) / 256.0)).round()
        );
    }
}

#[test]
fn of_integers() {
    for lead in 0..64 {
        for v in [
            1u64 << lead,
            (1 << lead) + (1 << lead) / 3,
            u64::MAX >> (63 - lead),
        ] {
            let Reciprocal { y, lead: found } = Reciprocal::of(v);
            assert_eq!(found, lead);
            let relative = f64::from(y) * (v as f64 / 2f64.powi(24 + lead as i32)) - 1.0;
            assert!(relative.abs() <= 2f64.powi(-22), "{v}: {relative}");
        }
    }
    assert_eq!(Reciprocal::of(0), Reciprocal::of(1));
}

/// Numbers outside the range of mantissas give meaningless results without a panic.
#[test]
fn other_numbers_do_not_panic() {
    for m in (0..=u32::MAX).step_by(65_521).chain([0, u32::MAX]) {
        assert!(recip(m) < 1 << 24);
    }
}
