//! Numbers in tables and messages.

/// Formats a count with commas between its thousands, and a half as `.5`.
pub fn number(count: f64) -> String {
    let digits = format!("{:.0}", count.trunc());
    let mut grouped = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    if count.fract() == 0.0 {
        grouped
    } else {
        grouped + ".5"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_thousands_and_shows_halves() {
        let shown = [0.0, 60.5, 999.0, 1000.0, 32600.0, 1234567.0].map(number);
        assert_eq!(shown, ["0", "60.5", "999", "1,000", "32,600", "1,234,567"]);
    }
}
