//! Messages of success disappear by themselves, and warnings stay until they no longer apply.

use super::*;

#[test]
fn good_news_pushes_no_warning_away() {
    let mut notices = Notices::default();
    notices.warn("no graphics card\n".to_owned());
    (0..9).for_each(|number| notices.tell(format!("saved {number}"), 1.0));
    assert_eq!(notices.all().len(), MOST);
    assert_eq!(notices.all()[0].words, "no graphics card");
    assert_eq!(notices.all()[MOST - 1].words, "saved 8");
    (0..9).for_each(|number| notices.warn(format!("fault {number}")));
    assert_eq!(notices.all().len(), MOST);
    assert_eq!(notices.all()[0].words, "fault 3");
}

#[test]
fn good_news_goes_by_itself_and_warnings_stay() {
    let mut notices = Notices::default();
    notices.warn("a fault".to_owned());
    assert_eq!(notices.next_end_s(), None);
    notices.tell("saved".to_owned(), 10.0);
    let end_s = notices.next_end_s().unwrap();
    notices.expire(end_s - 0.1);
    assert_eq!(notices.all().len(), 2);
    notices.expire(end_s);
    assert_eq!(notices.all().len(), 1);
    assert_eq!((notices.next_end_s(), notices.all()[0].until_s), (None, None));
}

#[test]
fn what_is_true_no_more_is_not_said() {
    let mut notices = Notices::default();
    notices.warn("the style stays: line 1".to_owned());
    notices.warn("another fault".to_owned());
    notices.retract("the style stays: ");
    assert_eq!(notices.all().len(), 1);
    notices.dismiss(7);
    notices.dismiss(0);
    assert!(notices.all().is_empty());
}
