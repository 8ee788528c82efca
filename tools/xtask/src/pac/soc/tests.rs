use super::{Access, NamedValue, Soc};

/// The three descriptions of a SoC with one timer.
fn descriptions() -> (String, String, String) {
    let register = |name: &str, offset: u32, fields: &str| {
        format!(
            "<register><name>{name}</name><description>Bits 0-31 of `X`. What it is.</description>\
             <addressOffset>{offset:#06x}</addressOffset><resetValue>0x01</resetValue><fields>{fields}</fields></register>"
        )
    };
    let field = |name: &str, msb: u32, lsb: u32| {
        format!("<field><name>{name}</name><msb>{msb}</msb><lsb>{lsb}</lsb></field>")
    };
    let svd = format!(
        "<device><peripherals><peripheral><name>TIMER0</name><baseAddress>0xF0000800</baseAddress><registers>{}{}{}{}\
         </registers><interrupt><name>timer0</name><value>1</value></interrupt></peripheral></peripherals></device>",
        register("LOAD", 0, &field("load", 7, 0)),
        register(
            "EV_PENDING",
            4,
            &(field("late", 4, 2) + &field("zero", 0, 0))
        ),
        register("UPTIME1", 8, &field("uptime", 31, 0)),
        register("UPTIME0", 12, &field("uptime", 31, 0)),
    );
    let json = r#"{
        "csr_bases": {"timer0": 4026533888},
        "csr_registers": {
            "timer0_load": {"addr": 4026533888, "size": 1, "type": "rw"},
            "timer0_ev_pending": {"addr": 4026533892, "size": 1, "type": "rw"},
            "timer0_uptime": {"addr": 4026533896, "size": 2, "type": "ro"}
        },
        "constants": {"build_id": 7, "config_clock_frequency": 81250000, "timer0_interrupt": 1, "config_cpu_name": "x", "config_has_i2c": null},
        "memories": {"main_ram": {"base": 1073741824, "size": 16, "type": "cached"}, "csr": {"base": 4026531840, "size": 65536, "type": "io"}}
    }"#;
    let description = r#"{"blocks": {"timer0": {
        "registers": [
            {"name": "load", "width": 8, "fields": []},
            {"name": "ev_pending", "width": 5, "fields": [
                {"name": "zero", "lsb": 0, "width": 1, "reset": 1, "values": []},
                {"name": "late", "lsb": 2, "width": 3, "reset": 0, "values": [{"value": 4, "name": "very", "text": "a day"}]}
            ]},
            {"name": "uptime", "width": 64, "fields": []}
        ],
        "counters": [],
        "constants": [{"name": "places", "value": 3, "text": "Places in the queue."}]
    }}}"#;
    (svd, json.to_owned(), description.to_owned())
}

fn refusal(svd: &str, json: &str, description: &str) -> String {
    format!("{:#}", Soc::read(svd, json, description).unwrap_err())
}

#[test]
fn joins_fields_and_access_rights() {
    let (svd, json, description) = descriptions();
    let soc = Soc::read(&svd, &json, &description).unwrap();
    assert_eq!(soc.build_id, 7);
    assert_eq!(
        soc.constants,
        [("config_clock_frequency".to_owned(), 81_250_000)]
    );
    assert_eq!(soc.memories.len(), 1);
    let [timer] = soc.peripherals.as_slice() else {
        panic!("one peripheral")
    };
    assert_eq!((timer.base, timer.interrupt), (0xf000_0800, Some(1)));
    let [load, pending, uptime] = timer.registers.as_slice() else {
        panic!("three registers")
    };
    assert_eq!(
        (load.access, load.width, load.fields.len()),
        (Access::ReadWrite, 8, 0)
    );
    let fields: Vec<_> = pending
        .fields
        .iter()
        .map(|f| (f.name.as_str(), f.lsb, f.width))
        .collect();
    assert_eq!(fields, [("zero", 0, 1), ("late", 2, 3)]);
    let very = NamedValue {
        value: 4,
        name: "very".to_owned(),
        text: "a day".to_owned(),
    };
    assert_eq!(pending.fields[1].values, [very]);
    assert_eq!(timer.constants[0].value, 3);
    assert_eq!(
        (uptime.access, uptime.words, uptime.width),
        (Access::ReadOnly, 2, 64)
    );
    assert_eq!((uptime.offset, uptime.reset), (8, 0x1_0000_0001));
    assert_eq!(uptime.description, "What it is.");
}

#[test]
fn refuses_descriptions_that_disagree() {
    let (svd, json, description) = descriptions();
    let moved = refusal(
        &svd.replace("0xF0000800", "0xF0001000"),
        &json,
        &description,
    );
    assert!(
        moved.contains("0xf0001000 in soc.svd and at 0xf0000800 in csr.json"),
        "{moved}"
    );
    let renamed = refusal(&svd.replace(">LOAD<", ">STORE<"), &json, &description);
    assert!(
        renamed.contains("`store` in soc.svd and `load` in csr.json"),
        "{renamed}"
    );
    let narrower = refusal(
        &svd,
        &json.replace("\"size\": 2", "\"size\": 1"),
        &description,
    );
    assert!(
        narrower.contains("`uptime1` in soc.svd and `uptime` in csr.json"),
        "{narrower}"
    );
    let low_word = svd.find("<register><name>UPTIME0").unwrap();
    let svd_only = refusal(
        &(svd[..low_word].to_owned() + "</registers></peripheral></peripherals></device>"),
        &json,
        &description,
    );
    assert!(
        svd_only.contains("`timer0_uptime` has 2 words in csr.json, fewer in soc.svd"),
        "{svd_only}"
    );
    let json_only = refusal(
        &svd,
        &json.replace(
            "\"timer0_load\"",
            "\"timer0_x\": {\"addr\": 1, \"size\": 1, \"type\": \"ro\"}, \"timer0_load\"",
        ),
        &description,
    );
    assert!(
        json_only.contains("csr.json has the register `timer0_x` at 0x00000001, soc.svd has not"),
        "{json_only}"
    );
    let undeclared = refusal(
        &svd,
        &json.replace("4026533892", "4026533920"),
        &description,
    );
    assert!(
        undeclared
            .contains("soc.svd has `timer0_ev_pending` at 0xf0000804, csr.json has nothing there"),
        "{undeclared}"
    );
}

#[test]
fn refuses_a_description_of_another_soc() {
    let (svd, json, description) = descriptions();
    for (from, to, message) in [
        (
            "timer0",
            "timer1",
            "soc.svd has the peripheral `timer0`, description.json has not",
        ),
        (
            "\"load\"",
            "\"store\"",
            "`timer0_load` of 8 bits in soc.svd is `timer0_store` of 8 bits",
        ),
        (
            "\"late\", \"lsb\": 2",
            "\"late\", \"lsb\": 1",
            "`late` from bit 2 of 3 bits, reset to 0, in soc.svd",
        ),
        ("\"reset\": 1", "\"reset\": 0", "reset to 1, in soc.svd"),
        (
            "\"value\": 4",
            "\"value\": 8",
            "values of the field `late` of `timer0` beyond its 3 bits",
        ),
        (
            "\"counters\": []",
            "\"counters\": [\"load\"]",
            "expected a plain register of 32 bits by that name",
        ),
        (
            "{\"timer0\"",
            "{\"more\": {\"registers\": [], \"counters\": [], \"constants\": []}, \"timer0\"",
            "the block `more`, soc.svd has not",
        ),
    ] {
        let found = refusal(&svd, &json, &description.replacen(from, to, 1));
        assert!(found.contains(message), "{found}");
    }
}

#[test]
fn refuses_what_it_does_not_know() {
    let (svd, json, description) = descriptions();
    assert!(
        refusal(&svd, &json.replace("\"rw\"", "\"wo\""), &description)
            .contains("expected \"ro\" or \"rw\"")
    );
    assert!(
        refusal(
            &svd,
            &json.replace("\"size\": 2", "\"size\": 3"),
            &description
        )
        .contains("3 words wide")
    );
    assert!(
        refusal(&svd, &json.replace("build_id", "other"), &description)
            .contains("no constant `build_id`")
    );
    assert!(refusal("<device>", &json, &description).contains("soc.svd is not XML"));
    assert!(refusal(&svd, "{", &description).contains("csr.json is not JSON"));
}
