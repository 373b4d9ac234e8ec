//! Time stamps as loggers write them: ISO 8601 and German dates, or the time of day alone.

/// A moment. Only differences of moments have a meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stamp {
    /// Days since a fixed day; none of a time of day alone.
    day: Option<i64>,
    /// Time of day [s], as UTC where the stamp says its zone.
    second: f64,
    /// Unit of the last digit as it is written [s].
    pub(crate) last_place: f64,
}

const DAY: f64 = 86_400.0;

impl Stamp {
    /// Reads `2024-03-05T12:00:00.125Z`, `2024-03-05 12:00:00,125`, `05.03.2024 12:00:00,125` or `12:00:00.125`; none if the text is
    /// something else. A sign of the decimals may be a point, a comma or a third colon.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let (date, clock) = match text.split_once(['T', ' ']) {
            Some((date, clock)) => (Some(day_of(date)?), clock.trim_start()),
            None => (None, text),
        };
        let (clock, ahead) = zone(clock)?;
        let mut parts = clock.splitn(3, ':');
        let (hour, minute) = (whole(parts.next()?, 2)?, whole(parts.next()?, 2)?);
        let seconds = parts.next()?;
        let (second, decimals) = match seconds.split_once(['.', ',', ':']) {
            Some((second, decimals)) if !decimals.is_empty() => (second, decimals),
            Some(_) => return None,
            None => (seconds, ""),
        };
        let second = whole(second, 2)?;
        // A leap second is the 61st.
        if hour > 23 || minute > 59 || second > 60 || !decimals.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        let part: f64 = format!("0.{decimals}0").parse().ok()?;
        Some(Self {
            day: date,
            second: (hour * 3600 + minute * 60 + second) as f64 - ahead + part,
            last_place: libm::exp10(-(decimals.len() as f64)),
        })
    }

    /// Time from another stamp to this one [s]. Times of day alone that go back by more than half a day have passed midnight.
    pub(crate) fn since(self, other: Self) -> f64 {
        let seconds = self.second - other.second;
        match (self.day, other.day) {
            (Some(day), Some(before)) => (day - before) as f64 * DAY + seconds,
            _ if seconds < -0.5 * DAY => seconds + DAY,
            _ => seconds,
        }
    }
}

/// The number of a date: `2024-03-05`, `2024/03/05`, `05.03.2024` or `5.3.24`.
fn day_of(date: &str) -> Option<i64> {
    let sign = ['-', '/', '.'].into_iter().find(|sign| date.contains(*sign))?;
    let mut parts = date.splitn(3, sign);
    let [first, month, last] = [parts.next()?, parts.next()?, parts.next()?];
    let (year, day) = if sign == '.' { (last, first) } else { (first, last) };
    let (year, month, day) = (whole(year, 4)?, whole(month, 2)?, whole(day, 2)?);
    if !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    // March is the first month, so that a leap day is the last one of its year.
    let (year, month) = if month > 2 { (year, month - 3) } else { (year - 1, month + 9) };
    Some(
        365 * year + year.div_euclid(4) - year.div_euclid(100)
            + year.div_euclid(400)
            + (153 * month + 2) / 5
            + day,
    )
}

/// A time without the zone behind it, and how far that is ahead of UTC [s].
fn zone(clock: &str) -> Option<(&str, f64)> {
    let clock = clock.trim_end_matches("UTC").trim_end();
    if let Some(clock) = clock.strip_suffix(['Z', 'z']) {
        return Some((clock, 0.0));
    }
    let Some(at) = clock.find(['+', '-', '−']) else { return Some((clock, 0.0)) };
    let (clock, shift) = clock.split_at(at);
    let sign = if shift.starts_with('+') { 1.0 } else { -1.0 };
    let digits: String = shift.chars().filter(char::is_ascii_digit).collect();
    let number = whole(&digits, 4)?;
    let minutes = if digits.len() > 2 { number / 100 * 60 + number % 100 } else { number * 60 };
    Some((clock.trim_end(), sign * 60.0 * minutes as f64))
}

/// A whole number of at most so many digits.
fn whole(text: &str, digits: usize) -> Option<i64> {
    let is_number = (1..=digits).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
    if is_number { text.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apart(first: &str, second: &str) -> f64 {
        Stamp::parse(second).unwrap().since(Stamp::parse(first).unwrap())
    }

    #[test]
    fn stamps_tell_the_time_between_them() {
        for (first, second, seconds) in [
            ("2024-03-05T12:00:00.000", "2024-03-05T12:00:00.125", 0.125),
            ("2024-03-05 12:00:00,000", "2024-03-05 12:01:00,000", 60.0),
            ("05.03.2024 23:59:59,9", "06.03.2024 00:00:00,1", 0.2),
            ("5.3.24 1:02:03", "5.3.24 1:02:04", 1.0),
            ("2024/02/28 00:00:00", "2024/03/01 00:00:00", 2.0 * DAY),
            ("2023-02-28T00:00:00Z", "2023-03-01T00:00:00Z", DAY),
            ("31.12.1999 00:00:00", "01.01.2000 00:00:00", DAY),
            ("2024-10-27T02:59:59+02:00", "2024-10-27T02:00:00+0100", 1.0),
            ("2024-03-05T12:00:00 UTC", "2024-03-05T14:00:01+02", 1.0),
            ("12:00:00.5", "12:00:00.75", 0.25),
            ("12:00:00:500", "12:00:00:750", 0.25),
            ("23:59:59.5", "00:00:00.5", 1.0),
            ("12:00:01", "12:00:00", -1.0),
        ] {
            assert!((apart(first, second) - seconds).abs() < 1e-9, "{first} to {second}");
        }
        // Microseconds keep their digits however late the date is.
        assert!((apart("2999-01-01T23:59:59.999990", "2999-01-01T23:59:59.999995") - 5e-6).abs() < 1e-10);
        assert_eq!(Stamp::parse("12:00:00,1250").unwrap().last_place, 1e-4);
        assert_eq!(Stamp::parse("12:00:00").unwrap().last_place, 1.0);
    }

    #[test]
    fn other_texts_are_none() {
        for text in [
            "",
            "12",
            "12.5",
            "10,25",
            "12:00",
            "25:00:00",
            "12:60:00",
            "12:00:61",
            "12:00:00.",
            "2024-13-01 12:00:00",
            "2024-03-32 12:00:00",
            "05.03.2024",
            "2024-03-05",
            "a:b:c",
            "-1:00:00",
            "12:00:00.1x",
            "Tue 12:00:00",
            "12:00:00+x",
            "12:00:00 +",
            "99999-01-01 00:00:00",
            "2024-03-05T",
            "T12:00:00",
            "١٢:00:00",
        ] {
            assert_eq!(Stamp::parse(text), None, "{text:?}");
        }
    }
}
