//! Windows of cameras: view volumes from sides and from matrices, compared with f64, and the reasons to refuse them.

use glint_core::camera::{Lens, Projection, Sides, View, ViewVolume};
use glint_core::fixed::{Q4_28, Q32_32, Turns, U4_28, U8_28};

use crate::random::Random;

/// Units of 2^−28.
const UNIT: f64 = 1.0 / (1 << 28) as f64;

/// A random number between two numbers.
fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    low + (high - low) * (random.next() as f64) / 2f64.powi(64)
}

fn volume(
    projection: Projection,
    sides: [f64; 4],
    near: f64,
    far: Option<f64>,
) -> Result<ViewVolume, String> {
    let [left, right, bottom, top] = sides.map(Q32_32::from_num);
    let sides = Sides {
        left,
        right,
        bottom,
        top,
    };
    let volume = ViewVolume::of_sides(
        projection,
        sides,
        U4_28::from_num(near),
        far.map(U8_28::from_num),
    );
    volume.map_err(|error| error.to_string())
}

/// Half width, half height, middle, near and far plane.
fn numbers(volume: &ViewVolume) -> [f64; 6] {
    let lens = &volume.lens;
    let [x, y] = lens.middle().map(Q4_28::to_num::<f64>);
    let [width, height] = [lens.half_width(), lens.half_height()].map(U8_28::to_num::<f64>);
    let far = volume.far.map_or(f64::INFINITY, U8_28::to_num);
    [width, height, x, y, lens.near().to_num(), far]
}

/// The matrix of `glFrustum` or `glOrtho`, times `factor`.
fn matrix(projection: Projection, [l, r, b, t, n, f]: [f64; 6], factor: f64) -> [[Q32_32; 4]; 4] {
    let rows = match projection {
        Projection::Perspective => [
            [2.0 * n / (r - l), 0.0, (r + l) / (r - l), 0.0],
            [0.0, 2.0 * n / (t - b), (t + b) / (t - b), 0.0],
            [0.0, 0.0, -(f + n) / (f - n), -2.0 * f * n / (f - n)],
            [0.0, 0.0, -1.0, 0.0],
        ],
        Projection::Orthographic => [
            [2.0 / (r - l), 0.0, 0.0, -(r + l) / (r - l)],
            [0.0, 2.0 / (t - b), 0.0, -(t + b) / (t - b)],
            [0.0, 0.0, -2.0 / (f - n), -(f + n) / (f - n)],
            [0.0, 0.0, 0.0, 1.0],
        ],
    };
    rows.map(|row| row.map(|x| Q32_32::from_num(factor * x)))
}

/// Sides and matrices of random volumes give the same numbers as f64.
#[test]
fn volumes_against_f64() {
    let mut random = Random(21);
    let mut worst = [0.0_f64; 3];
    for round in 0..20_000 {
        let projection = Projection::ALL[round % 2];
        let near: f64 = U4_28::from_num(between(&mut random, 0.01, 2.0)).to_num();
        // The numbers of the window at distance 1.
        let half = [0; 2].map(|_| between(&mut random, 0.1, 4.0));
        let [x, up] = [0; 2].map(|_| between(&mut random, -4.0, 4.0));
        let far: f64 = between(&mut random, near + 0.1, 20.0);
        let at = match projection {
            Projection::Perspective => near,
            Projection::Orthographic => 1.0,
        };
        let sides = [x - half[0], x + half[0], up - half[1], up + half[1]]
            .map(|side| Q32_32::from_num(at * side).to_num::<f64>());
        let [l, r, b, t] = sides;
        let exact = [
            (r - l) / at / 2.0,
            (t - b) / at / 2.0,
            (r + l) / at / 2.0,
            -(t + b) / at / 2.0,
            near,
            far,
        ];
        let of_sides = volume(projection, sides, near, Some(far)).expect("a volume");
        let factor = between(&mut random, 1.0, 8.0);
        let matrix = matrix(projection, [l, r, b, t, near, far], factor);
        let of_matrix = ViewVolume::of_matrix(&matrix).expect("a projection");
        for (index, found) in [of_sides, of_matrix].iter().map(numbers).enumerate() {
            for (found, exact) in found.into_iter().zip(exact).take(4) {
                worst[index] = worst[index].max((found - exact).abs() / UNIT);
            }
            for (found, exact) in found.into_iter().zip(exact).skip(4) {
                worst[2] = worst[2].max((found / exact - 1.0).abs());
            }
        }
    }
    println!(
        "window within {:.2} units of 2^-28 from sides, {:.1} from matrices; near and far plane within {:.1e}",
        worst[0], worst[1], worst[2]
    );
    // The entries of a matrix are rounded to 2^−32.
    assert!(worst[0] <= 0.51 && worst[1] <= 8.0 && worst[2] <= 1e-6);
}

/// Symmetric sides with the aspect ratio of the picture give the same lens as a half width, bit for bit. A far plane at infinity or
/// beyond 256 world units is left out.
#[test]
fn square_pixels_and_far_planes() {
    let mut random = Random(22);
    for round in 0..2000 {
        let projection = Projection::ALL[round % 2];
        let h: f64 = between(&mut random, 0.05, 2.0);
        let found = volume(
            projection,
            [-h, h, -h * 9.0 / 16.0, h * 9.0 / 16.0],
            1.0,
            None,
        )
        .expect("a volume");
        let lens = Lens::new(projection, found.lens.half_width(), U4_28::ONE).expect("a lens");
        assert_eq!((found.lens, found.far), (lens, None));
        assert_eq!(lens.scales([320, 180])[0], lens.scales([320, 180])[1]);
    }
    let infinite = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, -1], [0, 0, -1, 0]]
        .map(|row| row.map(Q32_32::from_num));
    let found = ViewVolume::of_matrix(&infinite).expect("a projection");
    assert_eq!((found.lens.near(), found.far), (U4_28::lit("0.5"), None));
    assert_eq!(found.lens.half_width(), 1);
    let distant = matrix(
        Projection::Perspective,
        [-1.0, 1.0, -1.0, 1.0, 1.0, 300.0],
        1.0,
    );
    assert_eq!(
        ViewVolume::of_matrix(&distant).map(|volume| volume.far),
        Ok(None)
    );
}

#[test]
fn two_fields_of_view() {
    let view = View::spherical(Q32_32::from_num(2), Turns(0), Turns(0)).expect("in range");
    let angles = ["150", "112.5"].map(|x| Turns::from_degrees(x.parse().expect("a number")));
    let wide = view.with_fields_of_view(angles).expect("in range");
    let lens = wide.lens();
    let found = [lens.half_width(), lens.half_height()].map(U8_28::to_num::<f64>);
    let exact = [75.0_f64, 56.25].map(|x| x.to_radians().tan());
    for (found, exact) in found.into_iter().zip(exact) {
        assert!((found / exact - 1.0).abs() <= 2f64.powi(-22));
    }
    assert_eq!(
        lens.scales([320, 180]),
        [(160, lens.half_width()), (90, lens.half_height())]
    );
    // A zoom keeps the aspect ratio; a half width or a single angle restores square pixels.
    let zoomed = wide.zoomed(U8_28::from_num(2)).expect("in range");
    let halves = |view: &View| [view.lens().half_width(), view.lens().half_height()];
    assert_eq!(
        halves(&zoomed).map(|x| x.to_bits()),
        halves(&wide).map(|x| x.to_bits() / 2)
    );
    let again = wide.with_field_of_view(angles[0]).expect("in range");
    assert_eq!(again, view.with_field_of_view(angles[0]).expect("in range"));
    assert_eq!(wide.with_half_width(wide.half_width()), Ok(again));
}

/// Each line is a matrix, row by row, or the kind and sides of a volume, and a part of the error.
const REFUSED: &str = "
    1 0 0 0  0 1 0 0  0 0 -1 -1  0 0 -1 0 => ok
    1 0 0 0  0 1 0 0  0 0 -1 -1  0 0 0 0 => row 4, column 4 is 0: expected above 0 in orthographic projection
    1 0 0 0  0 1 0 0  0 0 -1 -1  0 0 1 0 => row 4, column 3 is 1: expected below 0 in perspective projection
    1 0 0 0  0 1 0 0  0 0 -1 -1  0 0 -1 1 => row 4, column 4 is 1: expected 0 in perspective
    1 0 0 0  0 1 0 0  0 0 -1 -1  0 0 0 -1 => row 4, column 4 is -1: expected above 0
    1 0 0 0  0 1 0 0  0 0 -1 -1  0.5 0 -1 0 => row 4, column 1 is 0.5: expected 0
    1 0 0 0  0 1 0 0  0 2 -1 -1  0 0 -1 0 => row 3, column 2 is 2: expected 0
    1 0.25 0 0  0 1 0 0  0 0 -1 -1  0 0 -1 0 => row 1, column 2 is 0.25: expected 0
    1 0 0 3  0 1 0 0  0 0 -1 -1  0 0 -1 0 => row 1, column 4 is 3: expected 0
    1 0 3 0  0 1 0 0  0 0 -1 -1  0 0 0 1 => row 1, column 3 is 3: expected 0 in orthographic projection
    -1 0 0 0  0 1 0 0  0 0 -1 -1  0 0 -1 0 => row 1, column 1 is -1: expected above 0
    1 0 0 0  0 0 0 0  0 0 -1 -1  0 0 -1 0 => row 2, column 2 is 0: expected above 0
    1 0 0 0  0 1 0 0  0 0 0 -1  0 0 -1 0 => row 3, column 3 is 0: expected below 0
    1 0 0 0  0 1 0 0  0 0 -1 1  0 0 -1 0 => near 0
    1 0 0 0  0 1 0 0  0 0 -0.5 -1  0 0 -1 0 => far 0: expected beyond the near plane
    1 0 7 0  0 1 0 0  0 0 -1 -1  0 0 -1 0 => middle of the picture 7
    0.001 0 0 0  0 1 0 0  0 0 -1 -1  0 0 -1 0 => half_width 1000
    0.0000000003 0 2147483647 0  0 1 0 0  0 0 -1 -1  0 0 -1 0 => half_width
    1 0 0 0  0 1000 0 0  0 0 -1 -1  0 0 -1 0 => half_height 0.001
    2147483647 0 0 0  0 2147483647 0 0  0 0 -1 -2147483648  0 0 -2147483648 0 => far 0
";

#[test]
fn refused_matrices() {
    for case in REFUSED.lines().filter(|case| case.contains("=>")) {
        let (text, expected) = case.split_once(" => ").expect("two parts");
        let mut words = text
            .split_whitespace()
            .map(|word| word.parse().expect("a number"));
        let matrix = [0; 4].map(|_| [0; 4].map(|_| words.next().expect("16 numbers")));
        let found = ViewVolume::of_matrix(&matrix);
        let found = found.map_or_else(|error| error.to_string(), |_| "ok".to_owned());
        assert!(found.contains(expected), "{text}: {found}");
    }
}

#[test]
fn refused_sides() {
    let perspective = Projection::Perspective;
    for (sides, near, far, expected) in [
        (
            [1.0, 1.0, -1.0, 1.0],
            1.0,
            None,
            "left 1, right 1: expected left below right",
        ),
        (
            [-1.0, 1.0, 1.0, -1.0],
            1.0,
            None,
            "bottom 1, top -1: expected bottom below top",
        ),
        ([-1.0, 1.0, -1.0, 1.0], 0.001, None, "half_width 1000"),
        ([-1e-3, 1e-3, -1e-3, 1e-3], 0.001, None, "near 0.001"),
        (
            [-1.0, 1.0, -1.0, 1.0],
            1.0,
            Some(1.0),
            "far 1: expected beyond the near plane, 1",
        ),
        (
            [5.5, 7.0, -1.0, 1.0],
            1.0,
            None,
            "middle of the picture 6.25",
        ),
        (
            [-1.0, 1.0, 5.5, 7.0],
            1.0,
            None,
            "middle of the picture -6.25",
        ),
        ([2e9, 2.1e9, -1.0, 1.0], 0.0, None, "half_width"),
        ([-2e9, 2e9, -2e9, 2e9], 1.0, None, "half_width"),
        ([-1.0, 1.0, -0.001, 0.001], 1.0, None, "half_height 0.001"),
    ] {
        let found = volume(perspective, sides, near, far).expect_err("refused");
        assert!(found.contains(expected), "{sides:?}: {found}");
    }
}
