//! `glint imu replay` with the model.

use crate::common::{all_refused, assert_has, folder, refused, report, said, succeed};

#[test]
fn logs_of_a_gyroscope() {
    let folder = folder("imu");
    // The sensor is at rest for 0.1 s, with noise and a bias, then rotates at 90 °/s about z for a second. The log contains only
    // the last sample of the last 10 ms.
    let mut log = String::from("gx,gy,gz,t_us,temp,ax,ay,az\n");
    for i in (0..=1090).chain([1100]) {
        let noise = i * 7 % 5 - 2;
        let turning = if i > 100 { 1476 } else { 0 };
        let [x, y, z] = [20 + noise, -10 - noise, 5 + turning];
        log += &format!("{x},{y},{z},{},-500,0,0,4096\n", 3_000_000 + i * 1000);
    }
    std::fs::write(folder.join("turn.csv"), &log).unwrap();
    let replay = |log: &str, more: &str| -> Vec<String> {
        let command = format!("imu replay {log} --out o.csv {more}");
        let mut said = vec![succeed(&folder, &command)];
        let out = std::fs::read_to_string(folder.join("o.csv")).unwrap();
        said.extend(out.lines().map(str::to_owned));
        said
    };
    let numbers =
        |line: &str| -> Vec<f64> { line.split(',').map(|word| word.parse().unwrap()).collect() };
    let said = replay("turn.csv", "--still 0.1 --json");
    assert_eq!(said[1], "t_us,w,x,y,z,yaw,pitch,roll");
    assert_eq!(said.len(), 2 + 1092);
    assert_eq!(
        said[2],
        "3000000,1.0000000000,0.0000000000,0.0000000000,0.0000000000,0.0000000,0.0000000,0.0000000"
    );
    let last = numbers(said.last().unwrap());
    assert_eq!(last[0], 4_100_000.0);
    // The angle is less than 90°: half a step is lost between the last sample at rest and the first sample in motion, and the
    // jump of the rate adds the error of the cubic interpolation.
    assert!((last[5] - 89.96).abs() < 0.02, "{last:?}");
    assert!(last[6].abs() < 0.1 && last[7].abs() < 0.1, "{last:?}");
    let summary: serde_json::Value = serde_json::from_str(&said[0]).unwrap();
    assert_eq!(summary["steps"], 1091);
    assert_eq!(summary["calibration"]["samples"], 100);
    let bias = serde_json::json!([20.0, -10.0, 5.0]);
    assert_eq!(summary["calibration"]["bias"], bias);
    let yaw = summary["end"]["yaw"].as_f64().unwrap();
    assert!((yaw - last[5]).abs() < 1e-6, "{yaw}");

    // Twice the sample period and half the rate per count give the same attitude. The gap of 10 ms
    // becomes an ordinary step, because the period is fixed.
    let said = replay("turn.csv", "--dt-us 2000 --gyro-lsb 32.8 --no-tilt");
    let start = "samples     1092 in 2.182 s: 1091 steps, 0 stale, ";
    assert!(said[0].starts_with(start), "{}", said[0]);
    let turned = numbers(said.last().unwrap())[5];
    // Without calibration, the rate includes the bias of 5 LSB.
    let expected = (991.0 * 1481.0 + 100.5 * 5.0) * 0.002 / 32.8;
    assert!((turned - expected).abs() < 0.1, "{turned} {expected}");

    // A sensor that lies on its side: gravity gives the roll, unless tilt correction is off.
    let side = "t_us,ax,ay,az,gx,gy,gz\n0,0,4096,0,0,0,0\n1000,0,4096,0,0,0,0\n";
    std::fs::write(folder.join("side.csv"), side).unwrap();
    let angles = |more: &str| numbers(replay("side.csv", more).last().unwrap())[5..].to_vec();
    assert_eq!(angles(""), [0.0, 0.0, 90.0]);
    assert_eq!(angles("--no-tilt"), [0.0, 0.0, 0.0]);

    let bad = side.replace("1000,0,4096", "1000,0,4096.5");
    std::fs::write(folder.join("bad.csv"), bad).unwrap();
    all_refused(
        &folder,
        "
        imu replay --out x.csv bad.csv
            bad.csv: line 3, column ay: expected a whole number from -32768 to 32767, found '4096.5'
        imu replay --out x.csv none.csv
            none.csv: expected a file to read, found No such file or directory (os error 2)
        imu replay --out x.csv side.csv --still 1
            side.csv: expected at least 64 samples in the first 1 s, found 2
        imu replay --out x.csv turn.csv --still 0.5
            turn.csv: line 103: expected a sensor at rest in the first 0.5 s, found gyroscope z of sample 101 is 1476 LSB from the first: expected at most 33, keep it still
        imu replay --out x.csv side.csv --gyro-lsb 0
            --gyro-lsb: expected a number of LSB per °/s from 8 to 4096, found '0'
        imu replay --out x.csv side.csv --accel-lsb 2g
            --accel-lsb: expected a whole number of LSB per g from 1024 to 32767, found '2g'
        imu replay --out x.csv side.csv --still -1
            --still: expected a number of seconds from 0 to 86400, found '-1'
        ",
    );
    assert!(!folder.join("x.csv").exists());
}

/// `--still 0` replays without a calibration, even a log that begins in motion.
#[test]
fn a_rest_of_zero_seconds_is_none() {
    let folder = folder("no-rest");
    let mut log = String::from("t_us,ax,ay,az,gx,gy,gz\n");
    for i in 0..200 {
        log += &format!("{},0,0,4096,{},20,-5\n", i * 1000, 40 * (i % 50));
    }
    std::fs::write(folder.join("log.csv"), log).unwrap();
    let replay = |more: &str| {
        let summary = report(&folder, &format!("imu replay log.csv --out o.csv {more}"));
        assert!(summary["calibration"].is_null(), "{more}: {summary}");
        std::fs::read_to_string(folder.join("o.csv")).unwrap()
    };
    let expected = replay("");
    for zero in ["0", "0.0"] {
        assert!(replay(&format!("--still {zero}")) == expected);
    }
    // The sensor is checked for motion during the requested rest.
    let error = refused(&folder, "imu replay log.csv --out r.csv --still 0.1");
    assert!(error.contains("keep it still"), "{error}");
}

/// No sample is lost when a 32-bit clock wraps. Warnings report a wrong time stamp and a gap.
#[test]
fn time_stamps_of_real_clocks() {
    let folder = folder("clocks");
    let write = |name: &str, stamps: &[u64]| {
        let mut log = String::from("t_us,ax,ay,az,gx,gy,gz\n");
        for stamp in stamps {
            log += &format!("{stamp},0,0,4096,0,0,1476\n");
        }
        std::fs::write(folder.join(name), log).unwrap();
    };
    // Twelve samples at 90 °/s. The time stamps wrap after the third sample.
    let wrapped: Vec<u64> = (0..12)
        .map(|i| (4_294_964_296 + 1000 * i) % (1 << 32))
        .collect();
    write("wrap.csv", &wrapped);
    let [summary, messages] = said(&folder, "imu replay wrap.csv --out wrapped.csv --json");
    assert_eq!(messages, "");
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!([&summary["steps"], &summary["stale"]], [11, 0]);
    assert_eq!(summary["seconds"], 0.011);
    let yaw = summary["end"]["yaw"].as_f64().unwrap();
    assert!((yaw - 0.99).abs() < 0.001, "{yaw}");

    let mut wild: Vec<u64> = (0..1000).map(|i| 1000 * i).collect();
    wild[500] = 77_000_000_000;
    wild.extend([5_000_000, 5_001_000]);
    write("wild.csv", &wild);
    let [summary, messages] = said(&folder, "imu replay wild.csv --out o.csv --json");
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["seconds"], 5.001);
    let yaw = summary["end"]["yaw"].as_f64().unwrap();
    assert!((yaw - 90.0).abs() < 0.001, "{yaw}");
    assert_has(&messages, "wild.csv: ignored samples: 1, ");
    assert_has(&messages, "wild.csv: gaps: 1, ");
}
