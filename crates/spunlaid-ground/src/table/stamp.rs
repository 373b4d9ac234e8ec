//! Time stamps as loggers and spreadsheets write them: a date and the time of day, or the time alone.

/// A moment. Only differences of moments have a meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stamp {
    /// Days since a fixed day, with the month before the day and behind it where a date can be read both
    /// ways; none of a time alone.
    days: Option<[i64; 2]>,
    /// Time of day [s], as UTC where the stamp says its zone.
    second: f64,
    /// After this time a stamp without a day begins again [s].
    period: f64,
    /// Unit of the last digit as it is written [s].
    pub last_place: f64,
}

/// How stamps may be written, for messages.
pub const FORMS: &str = "2024-03-05 12:00:00.125, 05.03.2024 12:00:00,125, 03/05/2024 12:00:00.125 \
    PM, 12:00:00.125 or, in minutes and seconds, 00:00.125";

const DAY: f64 = 86_400.0;
const HOUR: f64 = 3600.0;

impl Stamp {
    /// Reads a stamp as in [`FORMS`], also with `T` before the time and a zone behind it; none if the text is something
    /// else. A sign of the decimals may be a point, a comma or a third colon.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let (text, half) = half_of_day(text.trim());
        let (days, clock) = match text.split_once(['T', ' ']) {
            Some((date, clock)) => (Some(days_of(date)?), clock.trim_start()),
            None => (None, text),
        };
        let (clock, ahead) = zone(clock)?;
        let parts: Vec<&str> = clock.splitn(3, ':').collect();
        let (hour, minute, seconds) = match parts[..] {
            [hour, minute, seconds] => (whole(hour, 2)?, minute, seconds),
            // Without decimals these would be hours and minutes.
            [minute, seconds] if days.is_none() && half.is_none() && seconds.contains(['.', ',']) => {
                (0, minute, seconds)
            }
            _ => return None,
        };
        let minute = whole(minute, 2)?;
        let (second, decimals) = match seconds.split_once(['.', ',', ':']) {
            Some((second, decimals)) if !decimals.is_empty() => (second, decimals),
            Some(_) => return None,
            None => (seconds, ""),
        };
        let second = whole(second, 2)?;
        let hour = match half {
            Some(_) if !(1..=12).contains(&hour) => return None,
            Some(after_noon) => hour % 12 + if after_noon { 12 } else { 0 },
            None => hour,
        };
        // A leap second is the 61st.
        if hour > 23 || minute > 59 || second > 60 || !decimals.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        let part: f64 = format!("0.{decimals}0").parse().ok()?;
        Some(Self {
            days,
            second: (hour * 3600 + minute * 60 + second) as f64 - ahead + part,
            period: if parts.len() == 3 { DAY } else { HOUR },
            last_place: libm::exp10(-(decimals.len() as f64)),
        })
    }

    /// Time from another stamp to this one [s]. Stamps without a day that go back by more than half of their
    /// period have begun again: a day, or an hour of minutes and seconds.
    pub fn since(self, other: Self) -> f64 {
        let seconds = self.second - other.second;
        match (self.days, other.days) {
            (Some(days), Some(before)) => {
                // Where the order of day and month is not known, that of the nearer days is meant.
                let apart = [days[0] - before[0], days[1] - before[1]];
                let days = if apart[1].abs() < apart[0].abs() { apart[1] } else { apart[0] };
                days as f64 * DAY + seconds
            }
            _ if seconds < -0.5 * self.period => seconds + self.period,
            _ => seconds,
        }
    }
}

/// A stamp without AM or PM behind it, and whether it is after noon.
fn half_of_day(text: &str) -> (&str, Option<bool>) {
    [("am", false), ("pm", true), ("a.m.", false), ("p.m.", true)]
        .into_iter()
        .find_map(|(mark, after_noon)| {
            let (clock, end) = text.split_at_checked(text.len().checked_sub(mark.len())?)?;
            end.eq_ignore_ascii_case(mark).then_some((clock.trim_end(), Some(after_noon)))
        })
        .unwrap_or((text, None))
}

/// The number of a date, with the month before the day and behind it: `2024-03-05`, `2024/03/05`,
/// `05.03.2024`, `5.3.24`, `3/5/2024`, `05-03-2024` or `05-Mar-2024`.
fn days_of(date: &str) -> Option<[i64; 2]> {
    let sign = ['-', '/', '.'].into_iter().find(|sign| date.contains(*sign))?;
    let mut parts = date.splitn(3, sign);
    let [first, middle, last] = [parts.next()?, parts.next()?, parts.next()?];
    let day = |year, month, day| day_of(whole(year, 4)?, month, whole(day, 2)?);
    if let Some(month) = month_of(middle) {
        return day(last, month, first).map(|day| [day; 2]);
    }
    let number = |text| whole(text, 2);
    let year_is_last = last.len() == 4 || sign == '/' && first.len() <= 2;
    if sign == '.' {
        day(last, number(middle)?, first).map(|day| [day; 2])
    } else if year_is_last {
        let month_first = day(last, number(first)?, middle);
        let day_first = day(last, number(middle)?, first);
        Some([month_first.or(day_first)?, day_first.or(month_first)?])
    } else {
        day(first, number(middle)?, last).map(|day| [day; 2])
    }
}

/// The number of a month by its English name, or by the first three letters of it.
fn month_of(name: &str) -> Option<i64> {
    const MONTHS: [&str; 12] =
        ["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"];
    let start = name.get(..3)?.to_ascii_lowercase();
    MONTHS.iter().position(|month| *month == start).map(|index| index as i64 + 1)
}

/// The number of a day.
fn day_of(year: i64, month: i64, day: i64) -> Option<i64> {
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
            ("03/05/2024 11:59:59.5 AM", "03/05/2024 12:00:00.000 PM", 0.5),
            ("03/05/2024 11:59:59 PM", "03/06/2024 12:00:00 AM", 1.0),
            ("12:59:59 pm", "1:00:00 p.m.", 1.0),
            ("11:59:59.0 PM", "12:00:00.0 AM", 1.0),
            // The day is before the month, or behind it: the nearer one is meant.
            ("3/5/24 23:59:59", "4/5/24 00:00:00", 1.0),
            ("12/01/2024 23:59:59", "13/01/2024 00:00:00", 1.0),
            ("01/31/2024 23:59:59", "02/01/2024 00:00:00", 1.0),
            ("05-03-2024 23:59:59", "06-03-2024 00:00:00", 1.0),
            ("05-Mar-2024 23:59:59.5", "06-Mar-2024 00:00:00.0", 0.5),
            ("00:00.125", "00:01.5", 1.375),
            ("59:59,9", "00:00,1", 0.2),
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
            "13:00:00 PM",
            "0:30:00 AM",
            "00:61.5",
            "60:00.5",
            "05-Foo-2024 12:00:00",
            "PM",
        ] {
            assert_eq!(Stamp::parse(text), None, "{text:?}");
        }
    }
}
